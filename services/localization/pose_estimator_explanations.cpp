#include <algorithm>

#include "services/localization/map_agreement.hpp"
#include "services/localization/pose_estimator.hpp"
#include "services/localization/slip_match.hpp"

namespace slammot::localization {

/// The points of the scan, without the motion of the step.
void PoseEstimator::take_points(const ScanToPlace& placed, const Step& step) {
  points_.deskew(sweep_.corrected(placed.scan), step.speed_mps, step.yaw_rate_radps);
  points_.select(placed.scan, step.after.odom_from_base, placed.masks);
}

/// How the step came about, where odometry predicts it and may be wrong.
std::optional<ExplainedStep> PoseEstimator::explain(const ScanToPlace& placed,
                                                    const Step& by_wheels) {
  const bool may_be_judged = config_.belief.enabled &&
                             (by_wheels.is_by_wheels() || by_wheels.source == StepSource::kReach) &&
                             by_wheels.duration_s > 0.0 && matcher_.can_match(points_.matched());
  if (!may_be_judged) return std::nullopt;
  const auto take = [&](const Step& step) { take_points(placed, step); };
  const StepToExplain scan{prediction_.explanations(by_wheels),
                           prediction_.weights(),
                           prediction_.state().belief.usual_share,
                           prediction_.state().belief.steps,
                           points_,
                           placed.submaps.map(),
                           take};
  ExplainedStep explained = by_wheels.slip.is_active() ? explain_slip(scan, config_, matcher_)
                                                       : mixture_.explain(scan, matcher_);
  prediction_.weigh(explained.weights);
  placed.counters.matches.searches += explained.searches;
  if (explained.step.explanation == sensing::StepExplanation::kRoughWheels)
    ++placed.counters.odometry.rough;
  if (by_wheels.is_by_wheels() && explained.step.explanation == sensing::StepExplanation::kOther)
    ++placed.counters.odometry.disbelieved;
  return explained;
}

/// Where odometry leads farther than usual and is not believed, it may have leapt while the vehicle
/// went on as before: the place where it then is competes with those about where odometry leads.
std::optional<ExplainedStep> PoseEstimator::explain_or_doubt(const ScanToPlace& placed,
                                                             const Step& by_wheels) {
  constexpr double kFits = 0.5;  // of the usual share
  std::optional<ExplainedStep> explained = explain(placed, by_wheels);
  if (!explained) return explained;
  const bool has_match = explained->registered.matched_share >= config_.trust.least_matched_share;
  if (has_match && explained->step.explanation != sensing::StepExplanation::kOther)
    return explained;
  const std::optional<Step> doubted = prediction_.with_doubted_wheels(by_wheels);
  if (!doubted) return explained;
  const auto fit_of = [&](const matching::PointToLineResult& registered) {
    return fit_at(registered.matched_share, points_, registered.map_from_base.pose,
                  placed.submaps.map(), config_.map);
  };
  const double least_fit = std::max(kFits * prediction_.state().belief.usual_share,
                                    has_match ? fit_of(explained->registered) : 0.0);
  take_points(placed, *doubted);
  std::optional<ExplainedStep> stayed = explain(placed, *doubted);
  if (stayed && fit_of(stayed->registered) > least_fit) {
    ++placed.counters.odometry.jumps;
    return stayed;
  }
  prediction_.weigh(explained->weights);
  take_points(placed, explained->step);
  return explained;
}

}  // namespace slammot::localization
