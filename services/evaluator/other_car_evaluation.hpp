#pragma once

#include <cstddef>
#include <vector>

#include "common/metrics/scene.hpp"
#include "common/metrics/statistics.hpp"
#include "common/metrics/trajectory.hpp"

namespace slammot::evaluator {

/// Against motion capture of one other car. The estimated pose of the ego car transforms tracks
/// into the world.
struct OtherCarEvaluation {
  std::size_t scans = 0;  ///< With both cars in the truth.
  std::size_t matched_scans = 0;
  std::size_t identities = 0;  ///< Number of different matched tracks.
  metrics::ErrorSummary position_m;
  metrics::ErrorSummary velocity_mps;
  double false_moving_tracks_a_scan = 0.0;
};

/// Matches in each scan the nearest track, and prefers the track matched last.
OtherCarEvaluation evaluate_other_car(const std::vector<metrics::Scene>& scenes,
                                      const metrics::Trajectory& other_car);

}  // namespace slammot::evaluator
