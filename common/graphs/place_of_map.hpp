#pragma once

#include <span>
#include <vector>

#include "common/graphs/fix_errors.hpp"

namespace slammot::graphs {

/// Of the box in map that holds all fixes.
struct Extent {
  geometry::Vector2 middle_m;
  double size_m = 0.0;  ///< Diagonal.
};

/// Precondition: there is a fix.
Extent extent_of(std::span<const Fix> fixes);

/// A maximum of the density of enu_from_map.
struct PlaceMode {
  geometry::Pose2 enu_from_map;
  geometry::Matrix3 covariance;  ///< (x, y [m], heading [rad]).
  double weight = 0.0;           ///< Probability; of sum 1.
};

/// Density of enu_from_map given all fixes, as a sum of normal distributions, likeliest first:
/// poses are proposed by pairs of fixes, refined by Gauss and Newton, and weighed by Laplace's
/// method, under several sizes of the usual error. More than 500 fixes are thinned out. Empty if
/// the fixes determine nothing.
std::vector<PlaceMode> place_of_map(std::span<const Fix> fixes);

/// Mean squared difference of the density from a pose: a covariance if the pose is its mean.
geometry::Matrix3 spread_about(const geometry::Pose2& enu_from_map,
                               std::span<const PlaceMode> modes);

}  // namespace slammot::graphs
