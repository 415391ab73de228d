#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "common/files/result.hpp"
#include "common/geometry/pose2.hpp"
#include "common/metrics/statistics.hpp"
#include "common/metrics/trajectory.hpp"
#include "services/evaluator/result_files.hpp"

namespace slammot::evaluator {

/// Relative pose errors over pairs `delta_m` of path apart.
struct RelativeErrors {
  double delta_m = 0.0;
  metrics::ErrorSummary consecutive_m;  ///< Equals `evo_rpe -d N -u m`.
  metrics::ErrorSummary drift_m;  ///< From every pose, by the true path (`--all_pairs`, pairs from
                                  ///< the reference).
  metrics::ErrorSummary drift_rad;
};

struct TrajectoryEvaluation {
  std::size_t poses = 0;
  std::size_t pairs = 0;
  geometry::Pose2 world_from_map;               ///< By rigid alignment.
  metrics::ErrorSummary absolute_m;             ///< After rigid alignment.
  metrics::ErrorSummary absolute_from_start_m;  ///< After alignment of the first pose.
  std::vector<RelativeErrors> relative;
  std::vector<metrics::PosePair> matched;
};

/// Errors of the poses that have a true pose within `max_difference_ns`.
TrajectoryEvaluation evaluate_trajectory(const metrics::Trajectory& truth,
                                         const metrics::Trajectory& estimate,
                                         std::int64_t max_difference_ns);

/// Fails if truth and estimate have no common time: too few pairs.
std::optional<files::Error> fault_of_overlap(const metrics::Trajectory& truth,
                                             const metrics::Trajectory& estimate,
                                             const std::vector<metrics::PosePair>& pairs);

/// One sentence if the relative motions of estimate and truth differ by as much as their length:
/// the estimate is wrong, or both are of different drives or clocks.
std::optional<std::string> doubt_of_motion(const std::vector<metrics::PosePair>& pairs);

/// First and last stamp, "1.000 to 2.000 s".
std::string span_of(const metrics::Trajectory& trajectory);

/// Matched poses after rigid alignment of the estimate. Leaves out dropped scans, whose poses in
/// the trajectory are interpolated, if the result tells which scans were localized.
std::vector<metrics::PosePair> localized_in_world(const RunResult& result,
                                                  const TrajectoryEvaluation& trajectory);

}  // namespace slammot::evaluator
