#include "services/loop_closing/submap_odometry.hpp"

#include <algorithm>
#include <cmath>

namespace slammot::loop_closing {
namespace {

using geometry::Matrix3;
using geometry::Pose2;
using geometry::UncertainPose2;

constexpr double kAnyHeading_rad = 1.0;  // Largest one-sigma error of a heading that is still
                                         // informative.

/// Adds a floor, so that a degenerate covariance from localization can be inverted.
Matrix3 with_floor(Matrix3 covariance) {
  constexpr double kPositionFloorM = 0.01;
  constexpr double kHeadingFloorRad = 0.001;
  covariance.diagonal() +=
      Eigen::Vector3d(kPositionFloorM * kPositionFloorM, kPositionFloorM * kPositionFloorM,
                      kHeadingFloorRad * kHeadingFloorRad);
  return covariance;
}

bool is_finite(const Pose2& pose) {
  return std::isfinite(pose.x_m) && std::isfinite(pose.y_m) && std::isfinite(pose.heading_rad);
}

}  // namespace

bool is_sound(const flow::Submap& submap) {
  return is_finite(submap.odom_from_submap) && is_finite(submap.previous_from_submap.pose) &&
         submap.previous_from_submap.covariance.allFinite() &&
         is_finite(submap.submap_from_base_at_end) && std::isfinite(submap.travelled_m) &&
         std::all_of(submap.surfels.begin(), submap.surfels.end(), [](const flow::Surfel& surfel) {
           return std::isfinite(surfel.x_m) && std::isfinite(surfel.y_m) &&
                  std::isfinite(surfel.normal_x) && std::isfinite(surfel.normal_y);
         });
}

bool begins_island(const flow::Submap& submap) {
  return submap.previous_from_submap.covariance(2, 2) > kAnyHeading_rad * kAnyHeading_rad;
}

flow::Constraint odometric_constraint(const Place& previous, const flow::Submap& submap) {
  const bool follows_directly = submap.submap_id.value == previous.id.value + 1;
  UncertainPose2 previous_from_submap = submap.previous_from_submap;
  if (!follows_directly)
    previous_from_submap.pose =
        geometry::inverse(previous.odom_from_submap) * submap.odom_from_submap;
  previous_from_submap.covariance = with_floor(previous_from_submap.covariance);
  return {previous.id, submap.submap_id, flow::ConstraintKind::kOdometric, previous_from_submap};
}

}  // namespace slammot::loop_closing
