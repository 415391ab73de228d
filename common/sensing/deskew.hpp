#pragma once

#include <vector>

#include "common/sensing/scan.hpp"

namespace slammot::sensing {

/// During a sweep of this duration or a longer one the velocity changes: by 3 rad/s², a turn by
/// 0.1 degrees.
inline constexpr double kSlowSweep_s = 0.03;

/// End point of every beam in the base frame at the scan's stamp [m], deskewed with constant
/// velocity. One point a beam; a beam without echo gives the laser's origin. speed_mps is forward.
void deskew(const LaserScan& scan, double speed_mps, double yaw_rate_radps,
            std::vector<geometry::Vector2>& points_in_base_m);

}  // namespace slammot::sensing
