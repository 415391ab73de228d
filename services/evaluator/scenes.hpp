#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "common/files/result.hpp"
#include "common/metrics/scene.hpp"
#include "services/evaluator/result_files.hpp"
#include "services/evaluator/truth_files.hpp"

namespace slammot::evaluator {

/// Truth and tracks of each scan, in world.
struct Scenes {
  std::vector<metrics::Scene> scenes;
  std::vector<std::uint32_t> track_ids;  ///< By the index of tracks in the scenes.
};

/// Tracks are transformed by the true and the estimated pose of each scan. Scans without a true
/// pose are left out.
Scenes make_scenes(const RunResult& result, const Truth& truth, std::int64_t max_difference_ns);

/// Fails if objects or tracks are far from the vehicle, or no scan has objects (`has_objects`:
/// there are some).
std::optional<files::Error> fault_of_objects(const std::vector<metrics::Scene>& scenes,
                                             bool has_objects);

}  // namespace slammot::evaluator
