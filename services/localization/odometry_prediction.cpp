#include "services/localization/odometry_prediction.hpp"

#include <algorithm>
#include <utility>

#include "services/localization/step_explanations.hpp"
#include "services/localization/step_velocity.hpp"
#include "services/localization/wheel_jump.hpp"

namespace slammot::localization {
namespace {

using geometry::Pose2;

constexpr double kStandsWithin_m = 1e-4;      // a step: wheels that stand count nothing,
constexpr double kStandsWithin_radps = 0.01;  // and what a gyro says then is its bias
constexpr double kStandsAfter_s = 0.5;        // odometry may come less often than scans
constexpr double kFarStep_m = 5.0;       // a step by odometry longer than this and so many usual
constexpr double kFarStepShare = 8.0;    // ones is a jump: of a vehicle that drives slowly at any
                                         // possible speed
constexpr double kVelocityOver_s = 0.1;  // changes of the velocity take longer
constexpr std::int64_t kOdometryKept_ns = 1'000'000'000;  // by a checkpoint: what the next steps
                                                          // are compared with
constexpr std::int64_t kLongestLag_ns = 200'000'000;      // a vehicle that accelerates does so for
                                                          // longer

bool is_still(const Pose2& by_wheels, double duration_s) {
  return std::hypot(by_wheels.x_m, by_wheels.y_m) < kStandsWithin_m &&
         std::abs(by_wheels.heading_rad) <= kStandsWithin_radps * duration_s;
}

/// Pairs of scans determine the factor on wheel distance to a few percent, less well than a usual
/// prior. A sweep of another duration changes a scan of a turn much as a factor on the turn does:
/// one of them is estimated.
LocalizerConfig with_fitting_priors(LocalizerConfig config) {
  constexpr double kSigma = 0.08;
  if (config.belief.way_at_start != 1.0)
    config.motion.scale_prior = std::max(config.motion.scale_prior, kSigma);
  if (config.echoes.sweep_factor_sigma > 0.0) config.motion.turn_factor_prior = 0.0;
  return config;
}

}  // namespace

OdometryPrediction::OdometryPrediction(const LocalizerConfig& config)
    : config_(with_fitting_priors(config)),
      motion_of_one_clock_(config_.motion),
      stamps_(config.odometry.far_ahead_s) {
  motion_of_one_clock_.stamp_offset_prior_s = 0.0;
  state_.estimate = sensing::at_start(motion_of_one_clock_);
  state_.with_stamp_offset = sensing::at_start(config_.motion);
  state_.with_pivot = pivot_at_start();
  state_.belief.factors.way = config.belief.way_at_start;
  state_.belief.estimator = sensing::WheelFactorEstimator(state_.belief.factors);
}

void OdometryPrediction::add(const sensing::Odometry& sample) {
  if (config_.odometry.use_odometry && stamps_.believes(sample.stamp_ns)) odometry_.add(sample);
}

void OdometryPrediction::begin(std::int64_t stamp_ns) {
  const std::optional<Pose2> wheel_from_base = odometry_.wheel_from_base_at(stamp_ns);
  state_.last = LastScan{.stamp_ns = stamp_ns,
                         .has_wheels = wheel_from_base.has_value(),
                         .wheel_from_base = wheel_from_base.value_or(Pose2{})};
}

/// By the vehicle's greatest speed, and by the way of a usual step; in a gap it drives at most
/// twice as fast as usual.
bool OdometryPrediction::is_impossible(const Pose2& by_wheels, double duration_s) const {
  constexpr double kFasterInGap = 2.0;
  const double farthest_m =
      kFarStep_m + state_.belief.usual_drive_m *
                       std::max(kFarStepShare, kFasterInGap * usual_steps_in(duration_s));
  const double way_m = std::hypot(by_wheels.x_m, by_wheels.y_m);
  return way_m > farthest_m ||
         (config_.odometry.time_is_known && way_m > config_.odometry.fastest_mps * duration_s);
}

double OdometryPrediction::usual_steps_in(double duration_s) const {
  return config_.odometry.time_is_known ? duration_s / state_.belief.usual_step_s : 1.0;
}

/// Wheels that go on saying what cannot be are right, and the velocity is wrong: only a single step
/// is doubted for that.
bool OdometryPrediction::is_doubtful(const Pose2& by_wheels, double duration_s) const {
  return state_.last->knows_velocity && !state_.last->doubted_wheels &&
         is_wheel_jump(by_wheels, state_.last->speed_mps, state_.last->yaw_rate_radps, duration_s);
}

std::optional<Pose2> OdometryPrediction::wheel_from_base_at(std::int64_t stamp_ns) const {
  const std::optional<Pose2> at_stamp = odometry_.wheel_from_base_at(stamp_ns);
  if (!at_stamp || !state_.applies_stamp_offset) return at_stamp;
  const std::optional<Pose2> at_offset =
      odometry_.wheel_from_base_after(stamp_ns, to_ns(sensing::stamp_offset_s(state_.estimate)));
  return at_offset ? at_offset : at_stamp;
}

/// None where wheels spoke at one end of the step only. Of the last scan they may have spoken
/// since.
std::optional<Pose2> OdometryPrediction::step_by_wheels(const Step& step) const {
  std::optional<Pose2> before = wheel_from_base_at(state_.last->stamp_ns);
  if (!before && state_.last->has_wheels) before = state_.last->wheel_from_base;
  if (!before || !step.wheels.wheel_from_base) return std::nullopt;
  return geometry::inverse(*before) * *step.wheels.wheel_from_base;
}

/// What the wheels say of the step from the last scan to the stamp, or of one so much later.
std::optional<Pose2> OdometryPrediction::wheel_step(std::int64_t stamp_ns,
                                                    std::int64_t after_ns) const {
  const auto before = odometry_.wheel_from_base_after(state_.last->stamp_ns, after_ns);
  const auto after = odometry_.wheel_from_base_after(stamp_ns, after_ns);
  if (!before || !after) return std::nullopt;
  return sensing::corrected(geometry::inverse(*before) * *after,
                            static_cast<double>(stamp_ns - state_.last->stamp_ns) * 1e-9,
                            state_.belief.factors);
}

/// How the step changes with the offset, told from how it changed just before: with the step
/// itself, its noise would be taken for a change of the velocity, and both together for an offset.
/// Where steps are long, changes are large beside it.
Eigen::Vector3d OdometryPrediction::step_by_stamp_offset(std::int64_t stamp_ns,
                                                         double offset_s) const {
  if (have_jumped_lately()) return Eigen::Vector3d::Zero();
  const std::int64_t duration_ns = stamp_ns - state_.last->stamp_ns;
  const std::int64_t known_ns = std::min<std::int64_t>(0, to_ns(offset_s));
  const std::int64_t until_ns = duration_ns <= kLongestLag_ns ? known_ns - duration_ns : known_ns;
  const auto before = wheel_step(stamp_ns, until_ns - to_ns(kVelocityOver_s));
  const auto after = wheel_step(stamp_ns, until_ns);
  if (!before || !after) return Eigen::Vector3d::Zero();
  return geometry::difference(*after, *before) / kVelocityOver_s;
}

/// Whether the steps by which a change of the velocity is told may hold a jump of the wheels, which
/// is none.
bool OdometryPrediction::have_jumped_lately() const {
  return state_.last->trusted_s < kVelocityOver_s + 1e-9 * static_cast<double>(2 * kLongestLag_ns);
}

/// Over long steps, and where samples come late and many at once, nobody knows how fast it was at
/// either end; nor where wheels have jumped on the way.
bool OdometryPrediction::tells_of_stamps(std::int64_t stamp_ns) const {
  const std::int64_t from_ns = state_.last->stamp_ns;
  return !have_jumped_lately() && stamp_ns - from_ns <= kLongestLag_ns &&
         odometry_.is_dense(from_ns - kLongestLag_ns, stamp_ns, kLongestLag_ns);
}

sensing::MotionEstimate OdometryPrediction::moved_by_wheels(const Pose2& by_wheels,
                                                            std::int64_t stamp_ns,
                                                            double duration_s) const {
  const sensing::MotionEstimate& before = state_.estimate;
  const sensing::WheelStep likely = turned_as_likely(
      {.before_from_base = by_wheels,
       .duration_s = duration_s,
       .by_stamp_offset = state_.applies_stamp_offset
                              ? step_by_stamp_offset(stamp_ns, sensing::stamp_offset_s(before))
                              : Eigen::Vector3d::Zero(),
       .turn_variance_rad2 = turn_variance_rad2(duration_s)});
  return sensing::moved_by_wheels(
      before, likely, state_.applies_stamp_offset ? config_.motion : motion_of_one_clock_);
}

/// Either the wheels have jumped or the vehicle was stopped or pushed: the match decides.
sensing::MotionEstimate OdometryPrediction::doubted_velocity(const Pose2& by_wheels,
                                                             double duration_s) const {
  const sensing::Velocity by_wheels_mps{by_wheels.x_m / duration_s,
                                        by_wheels.heading_rad / duration_s};
  return sensing::with_doubted_velocity(state_.estimate, by_wheels_mps - state_.estimate.velocity);
}

void OdometryPrediction::follow_wheels(const Pose2& by_wheels, Step& step) const {
  if (state_.slip.is_active()) return follow_slip(by_wheels, step);
  step.source = StepSource::kOdometry;
  step.wheels.stood_s =
      is_still(by_wheels, step.duration_s) ? state_.last->stood_s + step.duration_s : 0.0;
  step.wheels.is_standing = step.wheels.stood_s > kStandsAfter_s;
  if (step.wheels.is_standing)
    step.after = sensing::stood_still(state_.estimate, step.duration_s, config_.motion);
  else step.after = moved_by_wheels(by_wheels, step.stamp_ns, step.duration_s);
}

void OdometryPrediction::go_on_at_velocity(const sensing::MotionEstimate& before,
                                           Step& step) const {
  step.explanation = sensing::StepExplanation::kOther;
  step.source = step.wheels.wheel_from_base || state_.last->has_wheels
                    ? StepSource::kVelocityThisOnce
                    : StepSource::kVelocityAlone;
  if (step.source == StepSource::kVelocityAlone)
    step.usual_duration_s = usual_duration_so_far_s(step, state_.belief, config_.belief);
  if (has_velocity(step, config_)) {
    step.after = sensing::moved_at_velocity(
        before, std::min(step.duration_s, config_.odometry.longest_step_s), config_.motion);
    return;
  }
  step.source = StepSource::kReach;
  step = StepExplanations(state_.estimate, state_.belief, config_, motion_of_one_clock_)
             .without_odometry(std::move(step));
}

/// Odometry speaks, and is wrong for longer than a step.
void OdometryPrediction::go_on_without_wheels(Step& step) const {
  if (has_velocity(step, config_))
    step =
        StepExplanations(state_.estimate, state_.belief, config_, motion_of_one_clock_).other(step);
  else go_on_at_velocity(state_.estimate, step);
  step.wheels.are_overruled = true;
}

Step OdometryPrediction::predict(std::int64_t stamp_ns, double sweep_s) const {
  Step step;
  step.stamp_ns = stamp_ns;
  step.duration_s = static_cast<double>(stamp_ns - state_.last->stamp_ns) * 1e-9;
  step.wheels.wheel_from_base = wheel_from_base_at(stamp_ns);
  step.odom_from_base_before = state_.estimate.uncertain_pose();
  step.last_was_sampled = state_.last->was_sampled;
  step.usual_duration_s = state_.belief.usual_step_s;
  step.wheels.turn_variance_rad2 = turn_variance_rad2(step.duration_s);
  std::optional<Pose2> by_wheels = step_by_wheels(step);
  if (by_wheels) {
    step.wheels.uncorrected = *by_wheels;
    by_wheels = sensing::corrected(*by_wheels, step.duration_s, state_.belief.factors);
    step.wheels.gained = gained_in_sweep(step, *by_wheels, sweep_s);
  }
  const bool was_disbelieved =
      state_.belief.last == sensing::StepExplanation::kOther && state_.last->has_wheels;
  const bool has_changed =
      config_.odometry.time_is_known && by_wheels &&
      sensing::has_changed(state_.belief, step.wheels.uncorrected, step.duration_s);
  step.wheels.have_begun = has_changed && !state_.last->wheels_have_counted;
  step.wheels.have_changed = has_changed && !step.wheels.have_begun;
  step.wheels.are_in_doubt =
      step.wheels.have_changed || (config_.odometry.time_is_known && by_wheels && was_disbelieved);
  const bool cannot_be = by_wheels && is_impossible(*by_wheels, step.duration_s);
  const bool is_jump = config_.odometry.time_is_known && by_wheels && !cannot_be &&
                       !step.wheels.have_begun && is_doubtful(*by_wheels, step.duration_s);
  step.wheels.are_doubted = cannot_be || is_jump;
  step.wheels.have_leapt = cannot_be && by_wheels->translation_m().norm() > kFarStep_m;
  if (state_.belief.is_disbelieved && by_wheels) go_on_without_wheels(step);
  else if (by_wheels && !step.wheels.are_doubted) follow_wheels(*by_wheels, step);
  else
    go_on_at_velocity(is_jump ? doubted_velocity(*by_wheels, step.duration_s) : state_.estimate,
                      step);
  return with_velocity(step, *state_.last);
}

std::optional<Step> OdometryPrediction::with_doubted_wheels(const Step& by_wheels) const {
  constexpr double kUnusual = 3.0;
  constexpr double kUnusual_m = 0.5;
  const double usual_m =
      state_.belief.usual_drive_m * std::max(1.0, usual_steps_in(by_wheels.duration_s));
  const bool is_unusual =
      by_wheels.is_by_wheels() &&
      by_wheels.wheels.uncorrected.translation_m().norm() > kUnusual * usual_m + kUnusual_m;
  if (!is_unusual || has_velocity(by_wheels, config_)) return std::nullopt;
  Step step = by_wheels;
  step.wheels.are_doubted = true;
  step.wheels.is_standing = false;
  step.wheels.stood_s = 0.0;
  go_on_at_velocity(state_.estimate, step);
  return with_velocity(step, *state_.last);
}

StepMixture OdometryPrediction::explanations(const Step& by_wheels) const {
  if (by_wheels.slip.is_active()) return slip_hypotheses(by_wheels);
  const StepExplanations alternatives{state_.estimate, state_.belief, config_,
                                      motion_of_one_clock_};
  if (by_wheels.source == StepSource::kReach) {
    StepMixture steps{by_wheels, alternatives.to_the_left(by_wheels),
                      alternatives.to_the_right(by_wheels), alternatives.like_the_last(by_wheels),
                      alternatives.straight_on(by_wheels)};
    for (Step& step : steps) step = with_velocity(step, *state_.last);
    return steps;
  }
  if (!by_wheels.is_by_wheels() || by_wheels.wheels.have_begun) return {by_wheels};
  StepMixture steps{by_wheels, alternatives.rough(by_wheels), alternatives.other(by_wheels)};
  if (auto recalibrated = alternatives.recalibrated(by_wheels)) steps.push_back(*recalibrated);
  for (Step& step : steps) step = with_velocity(step, *state_.last);
  return steps;
}

Pose2 OdometryPrediction::as_believed(const Pose2& by_wheels, double duration_s) const {
  return sensing::predict_step(sensing::corrected(by_wheels, duration_s, state_.belief.factors),
                               duration_s, state_.estimate.calibration, motion_of_one_clock_)
      .pose;
}

std::vector<sensing::Odometry> OdometryPrediction::recent_odometry() const {
  return state_.last ? odometry_.since(state_.last->stamp_ns - kOdometryKept_ns)
                     : std::vector<sensing::Odometry>{};
}

void OdometryPrediction::resume(const State& state, const std::vector<sensing::Odometry>& samples,
                                OdometryPrediction&& before) {
  state_ = state;
  if (!before.state_.last) odometry_ = std::move(before.odometry_);  // it bridges what was missed
  for (const sensing::Odometry& sample : samples) odometry_.add(sample);
}

}  // namespace slammot::localization
