#pragma once

#include <cstddef>

#include <Eigen/Core>

#include "common/geometry/squared.hpp"
#include "common/geometry/uncertain_pose2.hpp"

/// Priors of registrations of one scan to another, and what makes one count.
namespace slammot::localization {

inline constexpr double kSure_m = 0.01;     // one sigma of what is expected, if it is right,
inline constexpr double kSureShare = 0.02;  // and what the way adds
inline constexpr double kSure_rad = 0.005;
inline constexpr double kExpected_m = 0.1;  // one sigma of what is expected, if it may be wrong
inline constexpr double kExpected_rad = 0.02;
inline constexpr double kFloor_m = 0.01;  // one sigma of what two scans tell, at least
inline constexpr double kFloor_rad = 0.002;
inline constexpr double kLeastShare = 0.35;       // of the points that match
inline constexpr std::size_t kFewestPoints = 50;  // independent ones: fewer may be of one mover
inline constexpr double kSame_m = 0.05;           // two registrations that end nearer to each other
inline constexpr double kRivalShare = 0.9;  // another place that fits as well as this share of the
                                            // best: nothing is told

using geometry::squared;

/// What is expected, if it is right.
inline geometry::UncertainPose2 surely(const geometry::Pose2& pose, double way_m) {
  const double sigma_m = kSure_m + kSureShare * way_m;
  return {pose,
          Eigen::Vector3d(squared(sigma_m), squared(sigma_m), squared(kSure_rad)).asDiagonal()};
}

/// What is expected, if it may be wrong.
inline geometry::UncertainPose2 about(const geometry::Pose2& pose) {
  return {pose, Eigen::Vector3d(squared(kExpected_m), squared(kExpected_m), squared(kExpected_rad))
                    .asDiagonal()};
}

/// With the errors that registrations of two scans have in common.
inline geometry::UncertainPose2 with_floor(geometry::UncertainPose2 pose) {
  pose.covariance.diagonal() +=
      Eigen::Vector3d(squared(kFloor_m), squared(kFloor_m), squared(kFloor_rad));
  return pose;
}

}  // namespace slammot::localization
