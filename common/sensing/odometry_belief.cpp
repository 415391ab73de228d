#include "common/sensing/odometry_belief.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include "common/geometry/squared.hpp"

namespace slammot::sensing {
namespace {

using geometry::Matrix3;
using geometry::Pose2;

constexpr double kSwitchPerScan = 0.05;  // Probability that the explanation changes from one scan
                                         // to the next.

constexpr double kUnobserved_m = 0.5;  // a scan that knows a direction no better than this knows
                                       // nothing of it,
constexpr double kUnobserved_rad = 0.2;
constexpr double kMatchSigma_m = 0.01;  // of a step between two matches
constexpr double kMatchSigma_rad = 0.005;
constexpr double kStepSigma_m = 0.02;  // of the velocity between two matches, for the prediction
constexpr double kStepSigma_rad = 0.01;
constexpr double kStepShare = 0.05;  // noise of odometry, as a share of the step
constexpr double kForgetWay = 1e-4;  // variance that a step adds
constexpr double kForgetTurn = 1e-4;
constexpr double kLeastTurn_rad = 0.01;  // least turn that updates the turn factor
constexpr int kLeastSteps = 6;
constexpr double kLeastTurnOnTheSpot_rad = 0.1;
constexpr double kDriveShare = 0.5;  // of the usual drive: a step with less way counts as a turn on
                                     // the spot
constexpr double kKnownSigma = 0.1;
constexpr double kMisfitMemory = 0.1;
constexpr double kMostMisfit = 3.0;

using geometry::squared;

/// Wheels that count nothing while the vehicle moves tell nothing of their factors.
bool are_frozen(const Pose2& by_wheels, const Pose2& by_matches) {
  constexpr double kMoves_m = 0.03;
  constexpr double kMoves_rad = 0.02;
  return count_nothing(by_wheels) && (std::hypot(by_matches.x_m, by_matches.y_m) > kMoves_m ||
                                      std::abs(by_matches.heading_rad) > kMoves_rad);
}

}  // namespace

bool count_nothing(const Pose2& by_wheels) {
  constexpr double kNothing_m = 1e-4;
  constexpr double kNothing_rad = 1e-4;
  return std::hypot(by_wheels.x_m, by_wheels.y_m) < kNothing_m &&
         std::abs(by_wheels.heading_rad) < kNothing_rad;
}

double log_marginal_likelihood(const geometry::UncertainPose2& prediction, const Pose2& optimum,
                               const Matrix3& information) {
  const Eigen::Vector3d apart = geometry::difference(optimum, prediction.pose);
  const Matrix3 widened = Matrix3::Identity() + information * prediction.covariance;
  const Eigen::PartialPivLU<Matrix3> factors(widened);
  const double squared_error = apart.dot(factors.solve(information * apart));
  return -0.5 * (std::log(std::max(widened.determinant(), 1e-12)) + std::max(squared_error, 0.0));
}

Pose2 scan_optimum(const geometry::UncertainPose2& prediction, const Pose2& matched,
                   const Matrix3& information) {
  const Eigen::Vector3d pulled =
      prediction.covariance.ldlt().solve(geometry::difference(matched, prediction.pose));
  Matrix3 observed = information;
  observed.diagonal() += Eigen::Vector3d(1.0 / squared(kUnobserved_m), 1.0 / squared(kUnobserved_m),
                                         1.0 / squared(kUnobserved_rad));
  const Eigen::Vector3d beyond = observed.ldlt().solve(pulled);
  return {matched.x_m + beyond.x(), matched.y_m + beyond.y(),
          geometry::wrap_angle(matched.heading_rad + beyond.z())};
}

ExplanationWeights predicted(const ExplanationWeights& weights,
                             const OdometryBeliefConfig& config) {
  const double share = kSwitchPerScan;
  const double faulty = config.rough_prior + config.recalibrated_prior + config.other_prior;
  const ExplanationWeights fresh{1.0 - faulty, config.rough_prior, config.recalibrated_prior,
                                 config.other_prior};
  ExplanationWeights next{};
  for (std::size_t i = 0; i < next.size(); ++i)
    next[i] = (1.0 - share) * weights[i] + share * fresh[i];
  return next;
}

ExplanationWeights updated(const ExplanationWeights& weights,
                           const std::array<double, kStepExplanations>& log_likelihoods) {
  const double highest = *std::max_element(log_likelihoods.begin(), log_likelihoods.end());
  ExplanationWeights posterior{};
  double sum = 0.0;
  for (std::size_t i = 0; i < posterior.size(); ++i)
    sum += posterior[i] = weights[i] * std::exp(log_likelihoods[i] - highest);
  for (double& weight : posterior) weight /= sum;
  return posterior;
}

StepExplanation most_likely(const ExplanationWeights& weights) {
  return static_cast<StepExplanation>(std::max_element(weights.begin(), weights.end()) -
                                      weights.begin());
}

void WheelFactorEstimator::observe(const Pose2& by_wheels, const Pose2& by_matches,
                                   double duration_s, bool wheels_tell_turns) {
  if (are_frozen(by_wheels, by_matches)) return;
  ++steps_;
  const double way_m = by_wheels.x_m;
  way_variance_ += kForgetWay;
  const double way_innovation_m2 =
      way_variance_ * way_m * way_m + squared(kMatchSigma_m) + squared(kStepShare * way_m);
  const double way_gain = way_variance_ * way_m / way_innovation_m2;
  const double way_innovation_m = by_matches.x_m - factors_.way * way_m;
  misfit_ += kMisfitMemory * (squared(way_innovation_m) / way_innovation_m2 - misfit_);
  factors_.way += way_gain * way_innovation_m;
  way_variance_ *= 1.0 - way_gain * way_m;

  const double by_wheels_rad = wheels_tell_turns ? std::abs(by_wheels.heading_rad) : 0.0;
  const bool turns = std::max(by_wheels_rad, std::abs(by_matches.heading_rad)) > kLeastTurn_rad;
  const Eigen::Vector2d by(turns ? by_wheels.heading_rad : 0.0, duration_s);
  if (turns) turn_covariance_(0, 0) += kForgetTurn;
  const double innovation =
      geometry::wrap_angle(by_matches.heading_rad - factors_.turn * by_wheels.heading_rad -
                           factors_.turn_bias_radps * duration_s);
  const double variance = by.dot(turn_covariance_ * by) + squared(kMatchSigma_rad) +
                          squared(kStepShare * by_wheels.heading_rad);
  const Eigen::Vector2d gain = turn_covariance_ * by / variance;
  factors_.turn += gain.x() * innovation;
  factors_.turn_bias_radps += gain.y() * innovation;
  turn_covariance_ -= gain * (by.transpose() * turn_covariance_);
}

/// The factors are not updated by steps with wheel slip.
bool WheelFactorEstimator::is_known() const {
  constexpr double kLeastFactor = 0.5;  // less is no factor: the wheels slip
  return steps_ >= kLeastSteps && way_sigma() < kKnownSigma && misfit_ < kMostMisfit &&
         factors_.way > kLeastFactor;
}
double WheelFactorEstimator::way_sigma() const { return std::sqrt(std::max(way_variance_, 0.0)); }
double WheelFactorEstimator::turn_sigma() const {
  return std::sqrt(std::max(turn_covariance_(0, 0), 0.0));
}

Pose2 corrected(const Pose2& by_wheels, double duration_s, const WheelFactors& factors) {
  const double turn_rad =
      factors.turn * by_wheels.heading_rad + factors.turn_bias_radps * duration_s;
  const geometry::Vector2 moved_m =
      factors.way *
      (geometry::rotation(0.5 * (turn_rad - by_wheels.heading_rad)) * by_wheels.translation_m());
  return {moved_m.x(), moved_m.y(), geometry::wrap_angle(turn_rad)};
}

double log_odds_of(const Pose2& by_wheels, const geometry::UncertainPose2& by_scans) {
  constexpr double kRightShare = 0.02;  // of the way: tolerance of calibrated odometry
  constexpr double kRight_m = 0.01;
  constexpr double kRightTurnShare = 0.04;  // of the turn: the same
  constexpr double kRight_rad = 0.004;
  constexpr double kWrongShare = 0.4;
  constexpr double kWrong_m = 0.1;
  constexpr double kWrong_rad = 0.05;
  constexpr double kLeast = -2.0;
  constexpr double kMost = 1.5;
  const double way_m = std::max(std::hypot(by_wheels.x_m, by_wheels.y_m),
                                std::hypot(by_scans.pose.x_m, by_scans.pose.y_m));
  const double turn_rad =
      std::max(std::abs(by_wheels.heading_rad), std::abs(by_scans.pose.heading_rad));
  const Eigen::Vector3d right(squared(kRight_m + kRightShare * way_m),
                              squared(kRight_m + kRightShare * way_m + 0.5 * way_m * kRight_rad),
                              squared(kRight_rad + kRightTurnShare * turn_rad));
  const Eigen::Vector3d wrong(squared(kWrong_m + kWrongShare * way_m),
                              squared(kWrong_m + kWrongShare * way_m),
                              squared(kWrong_rad + kWrongShare * turn_rad));
  const Matrix3 information = by_scans.covariance.inverse();
  const double for_right =
      log_marginal_likelihood({by_wheels, right.asDiagonal()}, by_scans.pose, information);
  const double for_wrong =
      log_marginal_likelihood({by_wheels, wrong.asDiagonal()}, by_scans.pose, information);
  return std::clamp(for_right - for_wrong, kLeast, kMost);
}

bool wheels_tell_turns(const OdometryBelief& belief) {
  constexpr double kFrequentScans_s = 0.1;
  return belief.usual_step_s >= kFrequentScans_s;
}

bool both_stand(const OdometryComparison& comparison) {
  constexpr double kStill_m = 0.03;
  constexpr double kStill_rad = 0.01;
  const auto is_still = [&](const Pose2& pose) {
    return std::hypot(pose.x_m, pose.y_m) < kStill_m && std::abs(pose.heading_rad) < kStill_rad;
  };
  return is_still(comparison.by_wheels) &&
         (!comparison.by_scans || is_still(comparison.by_scans->pose));
}

OdometryBelief compared(OdometryBelief belief, const OdometryComparison& comparison) {
  constexpr double kBound = 4.0;
  constexpr double kMostDisbeliefs = 5.0;
  const double asked_more = 4.0 * std::min(static_cast<double>(belief.disbeliefs), kMostDisbeliefs);
  const double bound = 4.0 + asked_more;
  constexpr double kWrongBelow = -1.0;
  const double right_above = 1.0 + asked_more;
  constexpr double kWithoutMatch = 1.0;
  const auto& [by_wheels, as_believed, by_scans, duration_s, extra_odds, keyframe] = comparison;
  const double told = (by_scans ? log_odds_of(as_believed, *by_scans) : kWithoutMatch) + extra_odds;
  const double odds = both_stand(comparison) ? std::min(0.0, told) : told;
  belief.log_odds = std::clamp(belief.log_odds + odds, -kBound,
                               by_scans ? bound : std::max(belief.log_odds, 1.5));
  if (by_scans && belief.estimator.is_known()) {
    const double odds_of_factors =
        log_odds_of(corrected(by_wheels, duration_s, belief.estimator.factors()), *by_scans);
    belief.log_odds_of_factors =
        std::clamp(belief.log_odds_of_factors + odds_of_factors, -kBound, kBound);
  }
  if (by_scans) {
    belief.estimator.observe(by_wheels, by_scans->pose, duration_s, wheels_tell_turns(belief));
  }
  if (by_scans && belief.log_odds < kWrongBelow && !belief.is_disbelieved) {
    belief.is_disbelieved = true;
    ++belief.disbeliefs;
    belief.matched_velocity = {by_scans->pose.x_m / duration_s,
                               by_scans->pose.heading_rad / duration_s};
    belief.matched_velocity_variance =
        Eigen::Vector2d(squared(kStepSigma_m), squared(kStepSigma_rad)) / squared(duration_s) +
        Eigen::Vector2d(0.25, 0.01);
  } else if (belief.log_odds > right_above) {
    belief.is_disbelieved = false;
  }
  return belief;
}

bool confirms(const OdometryComparison& comparison) {
  constexpr double kTells_m = 0.03;  // one sigma of the way; along a bare wall nothing is told
  return comparison.by_scans && comparison.by_scans->covariance(0, 0) < squared(kTells_m) &&
         log_odds_of(comparison.as_believed, *comparison.by_scans) > 0.0;
}

Eigen::Vector2d unnoticed_error_m(const OdometryComparison& comparison, double unconfirmed_s) {
  if (!comparison.by_scans || comparison.duration_s <= 0.0) return Eigen::Vector2d::Zero();
  const geometry::Vector2 missed_m =
      comparison.by_scans->pose.translation_m() - comparison.as_believed.translation_m();
  return geometry::rotation(-comparison.by_scans->pose.heading_rad) * missed_m *
         (unconfirmed_s / comparison.duration_s);
}

bool has_changed(const OdometryBelief& belief, const Pose2& by_wheels, double duration_s) {
  constexpr double kJitter_m = 0.012;  // encoder resolution and read-out times
  constexpr double kJitter_rad = 0.008;
  constexpr double kAcceleration_mps2 = 8.0;
  constexpr double kTurnAcceleration_radps2 = 6.0;
  // between_s: from the middle of the earlier step to the middle of this one
  const auto differs_from = [&](const Pose2& earlier, double earlier_s, double between_s) {
    if (earlier_s <= 0.0) return false;
    const double ratio = duration_s / earlier_s;
    const double apart_m = std::abs(by_wheels.x_m - ratio * earlier.x_m);
    const double apart_rad = std::abs(by_wheels.heading_rad - ratio * earlier.heading_rad);
    return apart_m > kJitter_m + kAcceleration_mps2 * duration_s * between_s ||
           apart_rad > kJitter_rad + kTurnAcceleration_radps2 * duration_s * between_s;
  };
  // A change in the middle of a step shows in full only against the step before the last.
  return differs_from(belief.last_by_wheels, belief.last_duration_s, duration_s) ||
         differs_from(belief.previous_by_wheels, belief.previous_duration_s,
                      duration_s + belief.last_duration_s);
}

OdometryBelief with_changed_wheels(OdometryBelief belief) {
  constexpr double kMostOdds = 1.0;
  if (!belief.is_disbelieved) belief.log_odds = std::min(belief.log_odds, kMostOdds);
  return belief;
}

OdometryBelief with_first_wheels(OdometryBelief belief) {
  belief.matched_velocity_variance = OdometryBelief().matched_velocity_variance;
  belief.last_duration_s = belief.previous_duration_s = 0.0;
  return belief;
}

OdometryBelief with_retimed_wheels(OdometryBelief belief, const OdometryBeliefConfig& config) {
  const OdometryBelief fresh;
  belief.weights = fresh.weights;
  belief.last = fresh.last;
  belief.factors = {};
  belief.factors.way = config.way_at_start;
  belief.estimator = WheelFactorEstimator(belief.factors);
  belief.log_odds = fresh.log_odds;
  belief.log_odds_of_factors = fresh.log_odds_of_factors;
  belief.disbeliefs = fresh.disbeliefs;
  belief.disbelieved_s = fresh.disbelieved_s;
  belief.is_disbelieved = fresh.is_disbelieved;
  belief.recalibrated_scans = fresh.recalibrated_scans;
  belief.last_duration_s = belief.previous_duration_s = 0.0;
  return belief;
}

OdometryBelief with_wheels(OdometryBelief belief, const Pose2& by_wheels, double duration_s) {
  const bool count_again = belief.last_duration_s > 0.0 && count_nothing(belief.last_by_wheels) &&
                           !count_nothing(by_wheels);
  if (belief.is_disbelieved && count_again) {
    belief.is_disbelieved = false;
    belief.log_odds = 0.0;
  }
  belief.previous_by_wheels = belief.last_by_wheels;
  belief.previous_duration_s = belief.last_duration_s;
  belief.last_by_wheels = by_wheels;
  belief.last_duration_s = duration_s;
  return belief;
}

double log_likelihood_of_acceleration(const Pose2& step, const Pose2& at_velocity,
                                      double duration_s) {
  constexpr double kAcceleration_mps2 = 5.0;
  constexpr double kTurnAcceleration_radps2 = 5.0;
  constexpr double kJitter_m = 0.02;  // odometry and scans are not read simultaneously
  constexpr double kJitter_rad = 0.01;
  constexpr double kLeast = -8.0;
  const Pose2 apart = geometry::inverse(at_velocity) * step;
  const double position = apart.translation_m().squaredNorm() /
                          squared(kJitter_m + kAcceleration_mps2 * squared(duration_s));
  const double heading =
      squared(apart.heading_rad / (kJitter_rad + kTurnAcceleration_radps2 * squared(duration_s)));
  return std::max(kLeast, -0.5 * (position + heading));
}

double step_after_gap_s(double usual_step_s, const OdometryBeliefConfig& config) {
  return usual_step_s * (1.0 + config.usual_step_memory * (kGapSteps - 1.0));
}

OdometryBelief moved(OdometryBelief belief, StepExplanation explanation, double duration_s,
                     const std::optional<Pose2>& before_from_base, const MotionModelConfig& motion,
                     const OdometryBeliefConfig& config) {
  belief.last = explanation;
  belief.usual_step_s += config.usual_step_memory * (duration_s - belief.usual_step_s);
  Eigen::Vector2d& variance = belief.matched_velocity_variance;
  variance += duration_s *
              Eigen::Vector2d(squared(motion.speed_walk_mps), squared(motion.yaw_rate_walk_radps));
  if (!before_from_base) return belief;
  belief.last_step = *before_from_base;
  belief.steps.add(*before_from_base);
  const double way_m = before_from_base->translation_m().norm();
  belief.usual_way_m += config.usual_step_memory * (way_m - belief.usual_way_m);
  const double turn_rad = std::abs(before_from_base->heading_rad);
  if (way_m > kDriveShare * belief.usual_drive_m)
    belief.usual_drive_m += config.usual_step_memory * (way_m - belief.usual_drive_m);
  else if (turn_rad > kLeastTurnOnTheSpot_rad)
    belief.usual_turn_rad += config.usual_step_memory * (turn_rad - belief.usual_turn_rad);
  const Eigen::Vector2d measured(before_from_base->x_m / duration_s,
                                 before_from_base->heading_rad / duration_s);
  const Eigen::Vector2d noise =
      (Eigen::Vector2d(kStepSigma_m, kStepSigma_rad) / duration_s).cwiseAbs2();
  const Eigen::Vector2d gain = variance.cwiseQuotient(variance + noise);
  belief.matched_velocity += gain.cwiseProduct(measured - belief.matched_velocity);
  variance = (Eigen::Vector2d::Ones() - gain).cwiseProduct(variance);
  return belief;
}

}  // namespace slammot::sensing
