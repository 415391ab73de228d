#include "services/localization/odometry_prediction.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace slammot::localization {
namespace {

using geometry::Pose2;

constexpr double kUsualShareMemory = 0.05;  // Weight of one scan in the usual matched share.

constexpr double kCertainSigmas = 2.5;  // stamped right, it is never more than 1.2 off:
                                        // docs/decisions/time-and-stamps.md

/// True if the step was made by wheels, and the match was free to contradict them.
bool tells_of_calibration(const Step& step, const ScanMatch& match) {
  return step.explanation == sensing::StepExplanation::kWheels && step.is_by_wheels() &&
         !step.wheels.is_standing && match.is_believed && !match.was_sampled && !match.is_lost &&
         !step.slip.is_active();
}

/// Another estimate of the same motion after the step, with the same match.
sensing::MotionEstimate beside(const sensing::MotionEstimate& before,
                               const sensing::WheelStep& by_wheels,
                               const sensing::MotionModelConfig& motion, const Step& step,
                               const ScanMatch& match) {
  const sensing::MotionEstimate predicted = sensing::moved_by_wheels(before, by_wheels, motion);
  return sensing::matched(predicted, sensing::matched_from(predicted.uncertain_pose(), step.prior(),
                                                           match.odom_from_base));
}

bool is_sure_of_velocity(const sensing::MotionEstimate& estimate) {
  constexpr double kSure_mps = 1.0;  // one sigma
  return estimate.covariance.bottomRightCorner<2, 2>()(0, 0) < kSure_mps * kSure_mps;
}

}  // namespace

void OdometryPrediction::observe(const Step& step, const ScanMatch& match) {
  state_.estimate =
      match.is_believed ? sensing::matched(step.after, match.odom_from_base) : step.after;
  if (step.duration_s > 0.0) learn_wheels(step, match);
  learn_turn_noise(step, match);
  learn_stamp_offset(step, match);
  learn_pivot(step, match);
  doubt_calibration(step, match);
  renew_map(matched_step(step, match), match);
  observe_slip(step, match);
  state_.last = last_after(step, match);
}

geometry::Vector2 OdometryPrediction::compare(const sensing::OdometryComparison& comparison) {
  constexpr double kAdoptAbove = 2.0;
  constexpr double kAdoptAfter_s = 8.0;  // wheels slip for seconds
  sensing::OdometryBelief& belief = state_.belief;
  const bool was_disbelieved = belief.is_disbelieved;
  belief = sensing::compared(belief, comparison);
  const geometry::Vector2 unnoticed_m =
      was_disbelieved || !belief.is_disbelieved
          ? geometry::Vector2::Zero()
          : sensing::unnoticed_error_m(comparison, unconfirmed_s(comparison));
  if (!was_disbelieved && belief.is_disbelieved && comparison.odom_from_keyframe)
    take_back_standing(comparison);
  if (sensing::confirms(comparison)) belief.confirmed_ns = state_.last->stamp_ns;
  belief.disbelieved_s = belief.is_disbelieved ? belief.disbelieved_s + comparison.duration_s : 0.0;
  if (belief.disbelieved_s < kAdoptAfter_s || belief.log_odds_of_factors < kAdoptAbove)
    return unnoticed_m;
  adopt_wheel_factors();
  belief.log_odds = belief.log_odds_of_factors;
  belief.is_disbelieved = false;
  return unnoticed_m;
}

/// The pose was held back by wheels that stand: it goes to where the scans have it.
void OdometryPrediction::take_back_standing(const sensing::OdometryComparison& comparison) {
  const geometry::UncertainPose2 keyframe{*comparison.odom_from_keyframe,
                                          state_.estimate.uncertain_pose().covariance};
  const geometry::UncertainPose2 placed = geometry::compound(keyframe, *comparison.by_scans);
  state_.estimate = sensing::put_at(state_.estimate, placed);
  state_.with_stamp_offset = sensing::put_at(state_.with_stamp_offset, placed);
  state_.with_pivot = sensing::put_at(state_.with_pivot, placed);
}

/// How long odometry has not been confirmed, at the scan of a comparison.
double OdometryPrediction::unconfirmed_s(const sensing::OdometryComparison& comparison) const {
  constexpr double kLongest_s = 10.0;
  if (state_.belief.confirmed_ns == 0) return comparison.duration_s;
  return std::min(kLongest_s,
                  1e-9 * static_cast<double>(state_.last->stamp_ns - state_.belief.confirmed_ns));
}

void OdometryPrediction::learn_wheels(const Step& step, const ScanMatch& match) {
  constexpr double kAdoptAbove = 0.8;
  constexpr int kAdoptAfterScans = 3;
  sensing::OdometryBelief& belief = state_.belief;
  const bool is_matched = match.is_believed && !match.is_lost;
  if (step.wheels.have_begun) belief = sensing::with_first_wheels(belief);
  const bool gap = is_gap(step);
  const auto by_matches =
      is_matched && !gap ? std::optional(matched_step(step, match)) : std::nullopt;
  belief = sensing::moved(belief, step.explanation, step.duration_s, by_matches, config_.motion,
                          config_.belief);
  if (gap) belief.usual_step_s = sensing::step_after_gap_s(step.usual_duration_s, config_.belief);
  if (is_matched)
    belief.usual_share += kUsualShareMemory * (match.matched_share - belief.usual_share);
  if (step.wheels.have_changed) belief = sensing::with_changed_wheels(belief);
  if (step.has_wheels() || step.wheels.are_doubted)
    belief = sensing::with_wheels(belief, step.wheels.uncorrected, gap ? 0.0 : step.duration_s);
  const bool tells_of_wheels = step.explanation != sensing::StepExplanation::kWheels &&
                               step.wheels.wheel_from_base && state_.last->has_wheels &&
                               !step.wheels.are_doubted;
  if (is_matched && tells_of_wheels && !match.was_sampled)
    belief.estimator.observe(step.wheels.uncorrected, matched_step(step, match), step.duration_s,
                             sensing::wheels_tell_turns(belief));
  const bool is_better =
      belief.weights[sensing::index_of(sensing::StepExplanation::kRecalibrated)] > kAdoptAbove;
  belief.recalibrated_scans = is_better ? belief.recalibrated_scans + 1 : 0;
  if (belief.recalibrated_scans >= kAdoptAfterScans) adopt_wheel_factors();
}

/// What was learned of the wheels beside the old factors is worth nothing beside the new ones.
void OdometryPrediction::adopt_wheel_factors() {
  sensing::OdometryBelief& belief = state_.belief;
  belief.recalibrated_scans = 0;
  ++belief.recalibrations;
  belief.factors = belief.estimator.factors();
  std::swap(belief.weights[sensing::index_of(sensing::StepExplanation::kWheels)],
            belief.weights[sensing::index_of(sensing::StepExplanation::kRecalibrated)]);
  const sensing::MotionEstimate fresh = sensing::at_start(motion_of_one_clock_);
  for (sensing::MotionEstimate* estimate :
       {&state_.estimate, &state_.with_stamp_offset, &state_.with_pivot}) {
    for (const int row : sensing::kWheelRows) {
      estimate->calibration[row - 3] = 0.0;
      estimate->covariance.row(row).setZero();
      estimate->covariance.col(row).setZero();
      estimate->covariance(row, row) = fresh.covariance(row, row);
    }
  }
}

sensing::MotionEstimate OdometryPrediction::pivot_at_start() const {
  sensing::MotionModelConfig of_another_point = motion_of_one_clock_;
  of_another_point.pivot_prior_m = config_.motion.doubted_pivot_prior_m;
  return sensing::at_start(of_another_point);
}

void OdometryPrediction::retime(double late_s, double sigma_s) {
  sensing::MotionEstimate fresh = sensing::at_start(config_.motion);
  fresh.calibration[sensing::kStampOffset - 3] = late_s;
  fresh.covariance(sensing::kStampOffset, sensing::kStampOffset) = sigma_s * sigma_s;
  fresh.velocity = state_.estimate.velocity;
  fresh.covariance.bottomRightCorner<2, 2>() = state_.estimate.covariance.bottomRightCorner<2, 2>();
  state_.estimate = sensing::put_at(fresh, state_.estimate.uncertain_pose());
  state_.applies_stamp_offset = true;
  state_.with_pivot = sensing::put_at(pivot_at_start(), state_.estimate.uncertain_pose());
  state_.applies_pivot = false;
  state_.innovations = {};
  state_.belief = sensing::with_retimed_wheels(state_.belief, config_.belief);
}

void OdometryPrediction::rescale(const sensing::WheelFactors& factors) {
  constexpr double kScaleSigma = 0.08;  // what few pairs of scans leave of the way's factor
  sensing::OdometryBelief& belief = state_.belief;
  belief = sensing::with_retimed_wheels(belief, config_.belief);
  belief.factors = factors;
  belief.estimator = sensing::WheelFactorEstimator(factors);
  ++belief.recalibrations;
  sensing::MotionModelConfig motion = motion_of_one_clock_;
  motion.scale_prior = std::max(motion.scale_prior, kScaleSigma);
  forget_calibration(sensing::at_start(motion));
  state_.innovations = {};
}

/// All estimates begin with the priors of `fresh`, the two beside the estimate with that of what
/// they learn, too.
void OdometryPrediction::forget_calibration(const sensing::MotionEstimate& fresh) {
  const auto begin_anew = [](const sensing::MotionEstimate& priors,
                             sensing::MotionEstimate& estimate) {
    estimate.calibration.setZero();
    estimate.covariance.middleRows<sensing::kCalibrations>(3).setZero();
    estimate.covariance.middleCols<sensing::kCalibrations>(3).setZero();
    estimate.covariance.block<sensing::kCalibrations, sensing::kCalibrations>(3, 3) =
        priors.covariance.block<sensing::kCalibrations, sensing::kCalibrations>(3, 3);
  };
  sensing::MotionModelConfig of_two_clocks = config_.motion;
  of_two_clocks.scale_prior = std::sqrt(fresh.covariance(3, 3));
  sensing::MotionEstimate of_pivot = fresh;
  of_pivot.covariance.block<2, 2>(sensing::kPivot, sensing::kPivot) =
      pivot_at_start().covariance.block<2, 2>(sensing::kPivot, sensing::kPivot);
  begin_anew(fresh, state_.estimate);
  begin_anew(sensing::at_start(of_two_clocks), state_.with_stamp_offset);
  begin_anew(of_pivot, state_.with_pivot);
  state_.applies_stamp_offset = state_.applies_pivot = false;
}

/// Learns the stamps' offset beside the estimate, which takes it over once it is certain.
void OdometryPrediction::learn_stamp_offset(const Step& step, const ScanMatch& match) {
  if (config_.motion.stamp_offset_prior_s == 0.0 || state_.applies_stamp_offset) return;
  sensing::MotionEstimate& watched = state_.with_stamp_offset;
  const double offset_s = sensing::stamp_offset_s(watched);
  const bool tells = tells_of_calibration(step, match) && tells_of_stamps(step.stamp_ns);
  const auto by_wheels = tells ? wheel_step(step.stamp_ns, to_ns(offset_s)) : std::nullopt;
  watched =
      by_wheels
          ? beside(watched,
                   {*by_wheels, step.duration_s, step_by_stamp_offset(step.stamp_ns, offset_s),
                    step.wheels.turn_variance_rad2},
                   config_.motion, step, match)
          : sensing::put_at(watched, state_.estimate.uncertain_pose());
  if (!by_wheels || std::abs(stamp_offset_s()) < kCertainSigmas * stamp_offset_sigma_s()) return;
  state_.estimate = watched;
  state_.applies_stamp_offset = true;
}

/// Learns a turning point beside the estimate, which takes it over once it is certain.
void OdometryPrediction::learn_pivot(const Step& step, const ScanMatch& match) {
  if (config_.motion.pivot_prior_m > 0.0 || config_.motion.doubted_pivot_prior_m == 0.0 ||
      state_.applies_pivot)
    return;
  sensing::MotionEstimate& watched = state_.with_pivot;
  const double offset_s = state_.applies_stamp_offset ? stamp_offset_s() : 0.0;
  const auto by_wheels =
      tells_of_calibration(step, match) ? wheel_step(step.stamp_ns, to_ns(offset_s)) : std::nullopt;
  watched = by_wheels ? beside(watched,
                               {*by_wheels, step.duration_s, Eigen::Vector3d::Zero(),
                                step.wheels.turn_variance_rad2},
                               motion_of_one_clock_, step, match)
                      : sensing::put_at(watched, state_.estimate.uncertain_pose());
  if (!by_wheels || !sensing::is_pivot_certain(watched)) return;
  state_.estimate = sensing::with_pivot_of(state_.estimate, watched);
  state_.with_stamp_offset = sensing::with_pivot_of(state_.with_stamp_offset, watched);
  state_.applies_pivot = true;
}

/// Matches that correct the heading or the way to the same side scan after scan tell of an error
/// that came since the calibration was learned, as of a wheel that drags: what is known of it is
/// given up as far as the error is large. Where scans are frequent: a mean over few seconds tells.
void OdometryPrediction::doubt_calibration(const Step& step, const ScanMatch& match) {
  constexpr double kFrequent_s = 0.06;
  constexpr double kLeastWay_m = 0.02;
  constexpr double kTurnsOfNoise = 1.8;  // sigmas in one scan: twice what sound wheels have at
                                         // most,
  constexpr double kWaysOfNoise = 1.25;  // and three times
  constexpr int kScale = 3;              // rows of the covariance
  constexpr int kHeadingRate = 4;
  if (!tells_of_calibration(step, match) || !config_.odometry.time_is_known ||
      step.duration_s <= 0.0 || step.usual_duration_s > kFrequent_s)
    return;
  const geometry::UncertainPose2 prior = step.prior();
  const Pose2 missed = geometry::inverse(prior.pose) * match.odom_from_base.pose;
  const geometry::Matrix3 told = prior.covariance - match.odom_from_base.covariance;
  const geometry::Vector2 ahead(std::cos(prior.pose.heading_rad), std::sin(prior.pose.heading_rad));
  const double way_m2 = ahead.dot(told.topLeftCorner<2, 2>() * ahead);
  const double way_m = step.before_from_base.x_m;
  auto& [turns, ways] = state_.innovations;
  if (told(2, 2) > 0.0)
    turns.add(missed.heading_rad / std::sqrt(told(2, 2)), missed.heading_rad / step.duration_s);
  if (way_m2 > 0.0 && std::abs(way_m) > kLeastWay_m)
    ways.add(missed.x_m / std::sqrt(way_m2), missed.x_m / way_m);
  const double turn_variance = turns.take_consistent(kTurnsOfNoise);
  const double way_variance = ways.take_consistent(kWaysOfNoise);
  for (sensing::MotionEstimate* estimate :
       {&state_.estimate, &state_.with_stamp_offset, &state_.with_pivot}) {
    estimate->covariance(kHeadingRate, kHeadingRate) += turn_variance;
    estimate->covariance(kScale, kScale) += way_variance;
  }
}

/// The map grows by what is matched to it, with the errors of those matches in it.
void OdometryPrediction::renew_map(const Pose2& before_from_base, const ScanMatch& match) {
  const double moved_m = std::hypot(before_from_base.x_m, before_from_base.y_m);
  const double share = renewed_share(match, moved_m, config_.match.new_below_m);
  state_.estimate = sensing::against_renewed_map(state_.estimate, share);
  state_.with_stamp_offset = sensing::against_renewed_map(state_.with_stamp_offset, share);
  state_.with_pivot = sensing::against_renewed_map(state_.with_pivot, share);
}

OdometryPrediction::LastScan OdometryPrediction::last_after(const Step& step,
                                                            const ScanMatch& match) const {
  const bool is_later = step.duration_s > 0.0;
  const bool is_by_velocity = is_later && !step.is_by_wheels();
  const bool tells = step.is_by_wheels() || is_sure_of_velocity(state_.estimate);
  return {.stamp_ns = step.stamp_ns,
          .has_wheels = step.wheels.wheel_from_base.has_value(),
          .wheel_from_base = step.wheels.wheel_from_base.value_or(Pose2{}),
          .knows_velocity = !is_gap(step) && (state_.last->knows_velocity || (is_later && tells)),
          .was_sampled = match.was_sampled,
          .speed_mps = is_by_velocity ? state_.estimate.velocity.x() : step.speed_mps,
          .yaw_rate_radps = is_by_velocity ? state_.estimate.velocity.y() : step.yaw_rate_radps,
          .doubted_wheels = step.wheels.are_doubted,
          .trusted_s = step.wheels.are_doubted ? 0.0 : state_.last->trusted_s + step.duration_s,
          .stood_s = step.wheels.stood_s,
          .wheels_have_counted =
              state_.last->wheels_have_counted ||
              (step.has_wheels() && !sensing::count_nothing(step.wheels.uncorrected))};
}

}  // namespace slammot::localization
