#pragma once

#include <vector>

#include "common/geometry/pose2.hpp"
#include "common/streets/driven_way.hpp"
#include "common/streets/seen_space.hpp"

namespace slammot::streets {

enum class View : std::uint8_t {
  kUnknown,  ///< Too little was seen.
  kOpen,     ///< Free beyond the building line.
  kClosed,   ///< Something stands there.
};

/// Parallel looks from the way, about a metre beside each other: to one side of a straight part of
/// it, or straight on where it turns, or back from where a turn ends.
struct ViewFan {
  std::vector<geometry::Pose2> looks;  ///< map_from_look, x in the direction of the look.
  std::vector<View> views;             ///< One a look.
  bool is_to_side = true;
  double nearest_m = 0.0;   ///< Along a look: where the node of a street may lie
  double farthest_m = 0.0;  ///< that is looked into.
};

/// What was seen beside and at the ends of the straight parts of a way: its side streets.
std::vector<ViewFan> side_views(const SeenSpace& seen, const DrivenWay& way);

/// A gap as wide as a street that goes on beyond the building line.
struct Opening {
  geometry::Pose2 map_from_look;  ///< Along its middle, from the way.
  double nearest_m = 0.0;         ///< As in the fan.
  double farthest_m = 0.0;
};

/// Openings to the sides, each once, though the way may pass it several times. Those where the way
/// turns tell little: the turn itself shows where the junction is.
std::vector<Opening> openings_of(const std::vector<ViewFan>& fans);

}  // namespace slammot::streets
