#pragma once

#include <cstddef>
#include <limits>
#include <optional>
#include <vector>

#include "common/geometry/pose2.hpp"
#include "common/streets/driven_way.hpp"
#include "common/streets/street_field.hpp"

namespace slammot::streets {

/// Radius of an area without an end: only a direction is known.
inline constexpr double kAnywhere_m = std::numeric_limits<double>::infinity();

/// What is known of where the way begins.
struct StartArea {
  geometry::Vector2 centre_m = geometry::Vector2::Zero();  ///< In streets.
  double radius_m = 100.0;
  std::optional<double> x_from_east_rad{};  ///< Direction of the map's x axis, if a compass or GNSS
  double direction_within_rad = 0.4;        ///< gives it, and its greatest error.
};

/// Always true without a start.
bool agrees_with_start(const geometry::Pose2& streets_from_map, const DrivenWay& way,
                       const std::optional<StartArea>& start);

/// True if the way begins, continues and ends at nearly the same places.
bool are_one_place(const geometry::Pose2& a, const geometry::Pose2& b, const DrivenWay& way);

/// Places streets_from_map where much of the way may lie along streets, best first, each once: some
/// of its points are laid onto all streets in both senses, and the best of each neighbourhood are
/// refined by least squares. The comparison is rough, so that a place stays in though a street is
/// missing.
std::vector<geometry::Pose2> proposed_places(const StreetField& field, const DrivenWay& way,
                                             const std::optional<StartArea>& start,
                                             std::size_t most);

}  // namespace slammot::streets
