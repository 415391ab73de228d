#include "services/evaluator/trajectory_evaluation.hpp"

#include "common/files/text.hpp"
#include "services/evaluator/stamps.hpp"

namespace slammot::evaluator {
namespace {

using files::Error;
using files::text;
using geometry::Pose2;
using metrics::PosePair;

double seconds(std::int64_t stamp_ns) { return static_cast<double>(stamp_ns) * 1e-9; }

std::vector<Pose2> true_poses(const std::vector<PosePair>& pairs) {
  std::vector<Pose2> poses;
  for (const PosePair& pair : pairs) poses.push_back(pair.truth);
  return poses;
}

std::vector<Pose2> estimated_poses(const std::vector<PosePair>& pairs) {
  std::vector<Pose2> poses;
  for (const PosePair& pair : pairs) poses.push_back(pair.estimate);
  return poses;
}

std::vector<double> translations_m(const std::vector<metrics::RelativeError>& errors) {
  std::vector<double> values;
  for (const auto& error : errors) values.push_back(error.translation_m);
  return values;
}

std::vector<double> rotations_rad(const std::vector<metrics::RelativeError>& errors) {
  std::vector<double> values;
  for (const auto& error : errors) values.push_back(error.rotation_rad);
  return values;
}

RelativeErrors relative(const std::vector<PosePair>& pairs, double delta_m) {
  const auto consecutive = metrics::relative_errors(
      pairs,
      metrics::pairs_by_path(estimated_poses(pairs), delta_m, metrics::PathPairs::kConsecutive));
  const auto all = metrics::relative_errors(
      pairs, metrics::pairs_by_path(true_poses(pairs), delta_m, metrics::PathPairs::kAll));
  return {delta_m, metrics::summarize(translations_m(consecutive)),
          metrics::summarize(translations_m(all)), metrics::summarize(rotations_rad(all))};
}

}  // namespace

std::optional<std::string> doubt_of_motion(const std::vector<PosePair>& pairs) {
  constexpr double kDeltaM = 10.0;
  constexpr double kMinDifferenceShare = 0.5;  // Systems with large drift stay below 0.02.
  constexpr std::size_t kMinPairs = 5;
  const auto ends =
      metrics::pairs_by_path(true_poses(pairs), kDeltaM, metrics::PathPairs::kConsecutive);
  if (ends.size() < kMinPairs) return std::nullopt;
  const double median_m =
      metrics::summarize(translations_m(metrics::relative_errors(pairs, ends))).median;
  if (median_m < kMinDifferenceShare * kDeltaM) return std::nullopt;
  return text(
      "the motions differ: over 10 m of the true path the result has an error of %.1f m, so the "
      "estimate is wrong, or the truth is of another drive or its clock is shifted",
      median_m);
}

TrajectoryEvaluation evaluate_trajectory(const metrics::Trajectory& truth,
                                         const metrics::Trajectory& estimate,
                                         std::int64_t max_difference_ns) {
  TrajectoryEvaluation evaluation;
  evaluation.matched = metrics::associate(truth, estimate, max_difference_ns);
  evaluation.poses = estimate.size();
  evaluation.pairs = evaluation.matched.size();
  evaluation.world_from_map = metrics::align_rigidly(evaluation.matched);
  evaluation.absolute_m =
      metrics::summarize(metrics::absolute_errors_m(evaluation.matched, evaluation.world_from_map));
  evaluation.absolute_from_start_m = metrics::summarize(metrics::absolute_errors_m(
      evaluation.matched, metrics::align_first_pose(evaluation.matched)));
  for (const double delta_m : {1.0, 10.0, 100.0})
    evaluation.relative.push_back(relative(evaluation.matched, delta_m));
  return evaluation;
}

std::string span_of(const metrics::Trajectory& trajectory) {
  return text("%.3f to %.3f s", seconds(trajectory.front().stamp_ns),
              seconds(trajectory.back().stamp_ns));
}

std::optional<Error> fault_of_overlap(const metrics::Trajectory& truth,
                                      const metrics::Trajectory& estimate,
                                      const std::vector<PosePair>& pairs) {
  constexpr std::size_t kMinPairs = 3;
  if (pairs.size() >= kMinPairs) return std::nullopt;
  return Error{text(
      "the clocks do not overlap: %zu poses of the result (%s) have a true pose at their time (%s)",
      pairs.size(), span_of(estimate).c_str(), span_of(truth).c_str())};
}

std::vector<PosePair> localized_in_world(const RunResult& result,
                                         const TrajectoryEvaluation& trajectory) {
  std::vector<PosePair> pairs;
  for (const PosePair& pair : trajectory.matched) {
    const bool was_localized =
        result.uncertain.empty() || at_stamp(result.uncertain, pair.stamp_ns, kSameStampNs);
    if (was_localized)
      pairs.push_back({pair.stamp_ns, pair.truth, trajectory.world_from_map * pair.estimate});
  }
  return pairs;
}

}  // namespace slammot::evaluator
