#pragma once

#include <filesystem>
#include <vector>

#include "common/files/result.hpp"
#include "common/metrics/map_sharpness.hpp"
#include "common/metrics/trajectory.hpp"

namespace slammot::evaluator {

/// Maps of the same scans, once from the estimated poses and once from the true ones.
struct WallSharpness {
  std::size_t scans = 0;
  metrics::MapSharpness of_estimate;
  metrics::MapSharpness of_truth;
};

struct WallSharpnessOptions {
  double cell_size_m = 0.0;  ///< 0: not evaluated.
  double longest_range_m = 80.0;
};

/// Reads the log and maps each scan that has a pair at its very stamp, from both poses. Sweeps of
/// sweep_s are straightened by the motion between the pairs.
files::Result<WallSharpness> wall_sharpness(const std::filesystem::path& log,
                                            const std::vector<metrics::PosePair>& pairs,
                                            double sweep_s, const WallSharpnessOptions& options);

}  // namespace slammot::evaluator
