#pragma once

#include <vector>

#include "common/sensing/scan.hpp"

namespace slammot::sensing {

/// End point of every beam in the base frame of the scan's stamp, the motion of the base during the sweep removed at
/// constant velocity. One point a beam; beams without an echo give the origin of the laser. [m]
/// speed_mps is forward.
void deskew(const LaserScan& scan, double speed_mps, double yaw_rate_radps, std::vector<geometry::Vector2>& points_in_base_m);

}  // namespace slammot::sensing
