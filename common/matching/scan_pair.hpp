#pragma once

#include <cstddef>
#include <vector>

#include "common/geometry/pose2.hpp"

namespace slammot::matching {

/// Two scans of a drive; ranges in recorded units, NaN for no echo.
struct ScanPair {
  std::vector<float> first;
  std::vector<float> second;
  geometry::Pose2 first_recorded;   ///< Odometry pose of the first scan, as recorded.
  geometry::Pose2 second_recorded;  ///< Odometry pose of the second scan, as recorded.
  std::size_t first_scan = 0;       ///< Counted from 0.
  std::size_t second_scan = 0;
};

/// Beam layout, stated or assumed.
struct AssumedBeams {
  double first_beam_rad = 0.0;
  double beam_step_rad = 0.0;
  double laser_heading_rad = 0.0;  ///< In base.
  geometry::Vector2 laser_in_base_m = geometry::Vector2::Zero();
};

}  // namespace slammot::matching
