#pragma once

#include <array>
#include <vector>

#include "common/geometry/pose2.hpp"
#include "common/traffic/way.hpp"

namespace slammot::traffic {

/// Two positions of an object that followed each other.
struct TrueStep {
  Mover mover = Mover::kVehicle;
  geometry::Vector2 from_m = geometry::Vector2::Zero();  ///< In the frame of the ways.
  geometry::Vector2 to_m = geometry::Vector2::Zero();
  bool is_in_view = false;
};

struct WayAccuracy {
  double travelled_m = 0.0;  ///< By true movers in view,
  double found_m = 0.0;      ///< of this on a way of their kind.
  double length_m = 0.0;     ///< Of the ways,
  double true_m = 0.0;       ///< of this where true movers of the kind passed, in view or not.

  double recall() const { return travelled_m > 0.0 ? found_m / travelled_m : 0.0; }
  double precision() const { return length_m > 0.0 ? true_m / length_m : 0.0; }
};

struct WayRule {
  double distance_m = 1.0;
  double angle_rad = 0.35;        ///< 20 degrees.
  double least_confidence = 0.0;  ///< Of the ways that count.
};

/// Ways against the ways of true movers, by kind: on one another are places within the rule's
/// distance whose directions agree, on walkways up to the sign.
std::array<WayAccuracy, kMovers> judge(const std::vector<Way>& ways,
                                       const std::vector<TrueStep>& steps, const WayRule& rule);

}  // namespace slammot::traffic
