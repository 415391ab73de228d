#pragma once

#include <Eigen/Core>

#include "common/geometry/pose2.hpp"

namespace slammot::sensing {

/// Pose of a scanner in space, in the base's frame: x ahead, y left, z up (REP-103).
struct SpatialMounting {
  Eigen::Vector3d position_in_base_m = Eigen::Vector3d::Zero();
  Eigen::Matrix3d base_from_laser = Eigen::Matrix3d::Identity();  ///< Rotation.
};

/// A planar mounting's height and tilt: right-handed turns about x (roll), then y (pitch), then z
/// (the heading).
struct Tilt {
  double up_m = 0.0;
  double roll_rad = 0.0;
  double pitch_rad = 0.0;
};

SpatialMounting in_space(const geometry::Pose2& base_from_laser, const Tilt& tilt);

/// True if the plane of the beams is steeper than 45 degrees: the scans are vertical profiles, of
/// use for heights and not for a planar map.
bool scans_vertically(const SpatialMounting& mounting);
bool scans_vertically(const Tilt& tilt);

/// Point at that range along the beam, in the base's frame.
Eigen::Vector3d point_in_base_m(const SpatialMounting& mounting, double beam_rad, double range_m);

}  // namespace slammot::sensing
