#include "common/sensing/spatial_mounting.hpp"

#include <cmath>
#include <numbers>

#include <Eigen/Geometry>

namespace slammot::sensing {

SpatialMounting in_space(const geometry::Pose2& base_from_laser, const Tilt& tilt) {
  const auto about = [](double angle_rad, const Eigen::Vector3d& axis) {
    return Eigen::AngleAxisd(angle_rad, axis);
  };
  return {{base_from_laser.x_m, base_from_laser.y_m, tilt.up_m},
          (about(base_from_laser.heading_rad, Eigen::Vector3d::UnitZ()) *
           about(tilt.pitch_rad, Eigen::Vector3d::UnitY()) *
           about(tilt.roll_rad, Eigen::Vector3d::UnitX()))
              .toRotationMatrix()};
}

bool scans_vertically(const SpatialMounting& mounting) {
  constexpr double kSteep_rad = 0.25 * std::numbers::pi;
  return std::abs(mounting.base_from_laser(2, 2)) < std::cos(kSteep_rad);
}

bool scans_vertically(const Tilt& tilt) { return scans_vertically(in_space({}, tilt)); }

Eigen::Vector3d point_in_base_m(const SpatialMounting& mounting, double beam_rad, double range_m) {
  const Eigen::Vector3d in_laser(range_m * std::cos(beam_rad), range_m * std::sin(beam_rad), 0.0);
  return mounting.position_in_base_m + mounting.base_from_laser * in_laser;
}

}  // namespace slammot::sensing
