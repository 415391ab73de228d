#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace slammot::sensing {

/// A scan of a log: its recorded stamp and the way from the previous scan by odometry.
struct ScanMark {
  std::optional<std::int64_t> stamp_ns;
  double way_m = 0.0;
  double turn_rad = 0.0;  ///< Absolute value.
};

/// Way to each scan from the one before, a radian counted as a metre.
inline std::vector<double> ways_of(std::span<const ScanMark> scans) {
  constexpr double kMetresPerRadian = 1.0;
  std::vector<double> ways;
  for (const ScanMark& scan : scans) ways.push_back(scan.way_m + kMetresPerRadian * scan.turn_rad);
  return ways;
}

}  // namespace slammot::sensing
