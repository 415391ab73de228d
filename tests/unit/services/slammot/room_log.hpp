#pragma once

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <string>

namespace slammot::testing {

/// CARMEN log of a robot that drives through the middle of a room of 10 m by 6 m, 181 beams, ten
/// scans a second.
inline std::string room_log(int scans) {
  std::string log = "# CARMEN Logfile\nPARAM robot_frontlaser_offset 0.0\n";
  for (int i = 0; i < scans; ++i) {
    const double x_m = 1.0 + 0.05 * i;
    char word[64];
    std::string ranges;
    for (int beam = 0; beam < 181; ++beam) {
      const double angle_rad = (beam - 90) * std::numbers::pi / 180.0;
      const double to_end_m = (10.0 - x_m) / std::max(1e-9, std::cos(angle_rad));
      const double to_side_m = 3.0 / std::max(1e-9, std::abs(std::sin(angle_rad)));
      std::snprintf(word, sizeof word, " %.2f", std::min(to_end_m, to_side_m));
      ranges += word;
    }
    std::snprintf(word, sizeof word, " %.3f 0 0 %.3f 0 0 %.6f host %.6f\n", x_m, x_m,
                  100.0 + 0.1 * i, 0.1 * i);
    log += "FLASER 181" + ranges + word;
  }
  return log;
}

}  // namespace slammot::testing
