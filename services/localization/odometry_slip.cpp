#include <cmath>
#include <optional>

#include "services/localization/odometry_prediction.hpp"
#include "services/localization/step_velocity.hpp"

namespace slammot::localization {
namespace {

/// The step under one of its hypotheses of the slip, from the pose that the same hypothesis had at
/// the last scan. before: the estimate there, of which the calibration stays.
Step under_slip(Step step, std::size_t hypothesis, const OdometryPrediction::State& before) {
  constexpr double kSpeedSigma_mps = 0.3;  // of a step, beside that of the slip
  constexpr double kYawRateSigma_radps = 0.05;
  const sensing::SlipHypothesis& slip = step.slip[hypothesis];
  step.odom_from_base_before = before.slip[hypothesis].odom_from_base;
  step.after = sensing::put_at(before.estimate, slip.odom_from_base);
  if (step.duration_s <= 0.0) return step;
  const geometry::Pose2 moved =
      geometry::inverse(step.odom_from_base_before.pose) * slip.odom_from_base.pose;
  step.after.velocity = {moved.x_m / step.duration_s, moved.heading_rad / step.duration_s};
  step.after.covariance.bottomRows<2>().setZero();
  step.after.covariance.rightCols<2>().setZero();
  step.after.covariance.bottomRightCorner<2, 2>().diagonal()
      << slip.slip_variance + kSpeedSigma_mps * kSpeedSigma_mps,
      kYawRateSigma_radps * kYawRateSigma_radps;
  return step;
}

}  // namespace

/// Wheels that slip tell the turn, and with the slip the way.
void OdometryPrediction::follow_slip(const geometry::Pose2& by_wheels, Step& step) const {
  geometry::UncertainPose2 before_from_base = sensing::predict_step(
      by_wheels, step.duration_s, state_.estimate.calibration, motion_of_one_clock_);
  before_from_base.covariance(2, 2) += step.wheels.turn_variance_rad2;
  step.source = StepSource::kOdometry;
  step.wheels.have_changed = step.wheels.are_in_doubt = false;
  step.slip = state_.slip.moved(before_from_base, step.duration_s);
  step = under_slip(step, step.slip.likeliest(), state_);
}

StepMixture OdometryPrediction::slip_hypotheses(const Step& by_wheels) const {
  StepMixture steps{};
  for (std::size_t i = 0; i < by_wheels.slip.size(); ++i)
    steps.push_back(with_velocity(under_slip(by_wheels, i, state_), *state_.last));
  return steps;
}

/// After the scan of the step was matched.
void OdometryPrediction::observe_slip(const Step& step, const ScanMatch& match) {
  constexpr double kFrequent_s = 0.06;  // else a vehicle changes its speed as much between scans
  constexpr double kStepsToNotice = 2.0;
  constexpr double kMost_mps = 4.0;  // more is no slip that lasts: one scan tells such wheels wrong
  state_.slip = step.slip;
  const bool was_found_elsewhere = match.is_believed && match.is_lost;
  const bool tells = config_.belief.enabled && config_.odometry.time_is_known &&
                     step.has_wheels() && !state_.belief.is_disbelieved &&
                     !step.wheels.have_begun && step.usual_duration_s <= kFrequent_s;
  if (!tells || was_found_elsewhere) {
    state_.slip = {};
    state_.speed_change.begin_anew();
    return;
  }
  if (step.duration_s <= 0.0) return;
  const std::optional<double> changed_mps =
      state_.speed_change.observe(step.wheels.uncorrected.x_m / step.duration_s, step.duration_s);
  if (!changed_mps) return;
  const bool have_frozen =
      !state_.slip.is_active() && sensing::count_nothing(step.wheels.uncorrected);
  const double by_mps = state_.belief.factors.way * *changed_mps;
  if (have_frozen || std::abs(by_mps) > kMost_mps) state_.slip = {};
  else if (!match.is_lost)
    state_.slip = state_.slip.changed(state_.estimate.uncertain_pose(), by_mps,
                                      kStepsToNotice * step.duration_s);
}

}  // namespace slammot::localization
