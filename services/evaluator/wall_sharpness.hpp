#pragma once

#include <filesystem>
#include <vector>

#include "common/files/result.hpp"
#include "common/metrics/map_sharpness.hpp"
#include "common/metrics/trajectory.hpp"

namespace slammot::evaluator {

/// Sharpness of maps of the same scans, at the estimated and at the true poses.
struct WallSharpness {
  std::size_t scans = 0;
  metrics::MapSharpness of_estimate;
  metrics::MapSharpness of_truth;
};

struct WallSharpnessOptions {
  double cell_size_m = 0.0;  ///< 0: not evaluated.
  double longest_range_m = 80.0;
};

/// Reads the log and maps each scan with a pair at its stamp, at both poses. Deskews sweeps of
/// `sweep_s` by the motion between pairs.
files::Result<WallSharpness> wall_sharpness(const std::filesystem::path& log,
                                            const std::vector<metrics::PosePair>& pairs,
                                            double sweep_s, const WallSharpnessOptions& options);

}  // namespace slammot::evaluator
