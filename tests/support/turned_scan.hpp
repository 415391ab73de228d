#pragma once

#include <cmath>
#include <cstddef>

#include <Eigen/Core>

#include "common/flow/segmented_scan.hpp"

namespace slammot::testing {

/// Echoes at 10 m of a scanner turned in odom, whose first beam does not point along an axis.
inline flow::SegmentedScan turned_scan(std::size_t beams, double beam_step_rad) {
  flow::SegmentedScan scan;
  scan.beam_step_rad = beam_step_rad;
  scan.odom_from_base.pose = {3.0, -2.0, 2.5};
  for (std::size_t beam = 0; beam < beams; ++beam) {
    const double angle_rad = -1.3 + static_cast<double>(beam) * beam_step_rad;
    scan.range_m.push_back(10.0F);
    scan.points_in_base_m.push_back(10.0F *
                                    Eigen::Vector2f(static_cast<float>(std::cos(angle_rad)),
                                                    static_cast<float>(std::sin(angle_rad))));
  }
  return scan;
}

}  // namespace slammot::testing
