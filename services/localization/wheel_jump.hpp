#pragma once

#include <cmath>

#include "common/geometry/pose2.hpp"

namespace slammot::localization {

// How much faster or slower a vehicle can have become from one scan to the next.
inline constexpr double kMostAcceleration_mps2 = 10.0;
inline constexpr double kMostTurnAcceleration_radps2 = 10.0;
inline constexpr double kWheelJitter_m = 0.1;  ///< Beyond that: wheels and scans are read at
                                               ///< different times.
inline constexpr double kWheelJitter_rad = 0.1;

/// Whether a step by wheels is none that the vehicle can have made at the velocity it had.
/// before_from_base_by_wheels: the step, duration_s long.
inline bool is_wheel_jump(const geometry::Pose2& before_from_base_by_wheels, double speed_mps,
                          double yaw_rate_radps, double duration_s) {
  const double turn_rad = yaw_rate_radps * duration_s;
  const geometry::Vector2 expected_m =
      speed_mps * duration_s *
      geometry::Vector2(std::cos(0.5 * turn_rad), std::sin(0.5 * turn_rad));
  const double most_m = kWheelJitter_m + kMostAcceleration_mps2 * duration_s * duration_s;
  const double most_rad = kWheelJitter_rad + kMostTurnAcceleration_radps2 * duration_s * duration_s;
  return (before_from_base_by_wheels.translation_m() - expected_m).norm() > most_m ||
         std::abs(geometry::wrap_angle(before_from_base_by_wheels.heading_rad - turn_rad)) >
             most_rad;
}

}  // namespace slammot::localization
