#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "common/geometry/uncertain_pose2.hpp"
#include "common/sensing/motion_model.hpp"
#include "common/sensing/step_history.hpp"

namespace slammot::sensing {

/// Explanations of a step between two scans: the components of the mixture that predicts the pose
/// of a scan.
enum class StepExplanation : std::uint8_t {
  kWheels,        ///< Odometry with the current calibration.
  kRoughWheels,   ///< The same mean with scaled noise: heavy tail of odometry.
  kRecalibrated,  ///< Odometry with the way and turn factors of recent matches.
  kOther,  ///< No odometry: constant velocity, or any position within reach if no time is known.
};
inline constexpr std::size_t kStepExplanations = 4;
using ExplanationWeights = std::array<double, kStepExplanations>;

inline constexpr std::size_t index_of(StepExplanation explanation) {
  return static_cast<std::size_t>(explanation);
}

struct OdometryBeliefConfig {
  bool enabled = true;
  double rough_prior = 0.03;         ///< After a change: share of kRoughWheels,
  double recalibrated_prior = 0.01;  ///< of kRecalibrated,
  double other_prior = 0.003;        ///< and of kOther.
  double rough_sigmas = 4.0;         ///< Noise of kRoughWheels, times that of kWheels.
  double share_nats = 60.0;  ///< Log-likelihood of all points matched against none, if points erred
                             ///< independently.
  double usual_step_memory = 0.1;  ///< Weight of one step in the usual time between scans.
  double reach_m = 0.3;            ///< kOther without time: one sigma of the position.
  double repeat_rad = 0.12;        ///< One sigma of the turn of a step that is like one before.
  double way_at_start = 1.0;  ///< Way by scans over way by odometry, as far as it is known before
                              ///< the first scan.
};

/// Log marginal likelihood of a scan [nats], up to a constant of the scan: integral of the
/// prediction times exp(-1/2 (x
/// - optimum)' information (x - optimum)). information: 3x3 over (x [m], y [m], heading [rad]) in
/// the prediction's frame, may be singular.
double log_marginal_likelihood(const geometry::UncertainPose2& prediction,
                               const geometry::Pose2& optimum,
                               const geometry::Matrix3& information);

/// Maximum of the scan's own likelihood, from a match (maximum a posteriori) with the prediction as
/// prior. Directions without information from the scan keep the match's value.
geometry::Pose2 scan_optimum(const geometry::UncertainPose2& prediction,
                             const geometry::Pose2& matched, const geometry::Matrix3& information);

/// Predicted weights for the next scan, from those after the last one.
ExplanationWeights predicted(const ExplanationWeights& weights, const OdometryBeliefConfig& config);

/// Bayes' rule. -infinity for an explanation that is not available; at least one must be available.
ExplanationWeights updated(const ExplanationWeights& weights,
                           const std::array<double, kStepExplanations>& log_likelihoods);

StepExplanation most_likely(const ExplanationWeights& weights);

/// Way factor, turn factor and turn bias of odometry by recursive least squares on matched steps.
struct WheelFactors {
  double way = 1.0;              ///< Way by matches over way by odometry.
  double turn = 1.0;             ///< Turn by matches over turn by odometry.
  double turn_bias_radps = 0.0;  ///< Turn rate by matches that odometry does not measure.
};

class WheelFactorEstimator {
 public:
  WheelFactorEstimator() = default;
  /// Sets the factors' priors.
  explicit WheelFactorEstimator(const WheelFactors& at_start) : factors_(at_start) {}

  /// One step by odometry (uncorrected) and by matches. wheels_tell_turns: a turn by the wheels
  /// alone is one, too, and not noise.
  void observe(const geometry::Pose2& by_wheels, const geometry::Pose2& by_matches,
               double duration_s, bool wheels_tell_turns = true);

  /// True if way and turn factors are certain enough for predictions.
  bool is_known() const;
  const WheelFactors& factors() const { return factors_; }
  double way_sigma() const;
  double turn_sigma() const;
  const Eigen::Matrix2d& turn_covariance() const { return turn_covariance_; }
  int steps() const { return steps_; }

  /// Passes each value of the state to the visitor, in a fixed order: for a checkpoint.
  template <typename Visitor>
  void visit(Visitor visit) const {
    visit(factors_), visit(way_variance_), visit(turn_covariance_), visit(steps_), visit(misfit_);
  }
  template <typename Visitor>
  void visit(Visitor visit) {
    visit(factors_), visit(way_variance_), visit(turn_covariance_), visit(steps_), visit(misfit_);
  }

 private:
  WheelFactors factors_;
  double way_variance_ = 0.25;
  Eigen::Matrix2d turn_covariance_ = Eigen::Vector2d(2.25, 0.01).asDiagonal();
  int steps_ = 0;
  double misfit_ = 1.0;  ///< Mean squared innovation of the way over its expected value.
};

/// The step with the factors applied.
geometry::Pose2 corrected(const geometry::Pose2& by_wheels, double duration_s,
                          const WheelFactors& factors);

/// State of odometry's validation, kept from scan to scan.
struct OdometryBelief {
  ExplanationWeights weights{1.0, 0.0, 0.0, 0.0};
  StepExplanation last = StepExplanation::kWheels;  ///< Most probable explanation of the last step.
  static constexpr double kUsualStepAtStart_s = 0.1;
  double usual_step_s = kUsualStepAtStart_s;  ///< Running mean of the time between scans.
  geometry::Pose2 last_step;                  ///< Last step by matches.
  StepHistory steps;                          ///< Earlier steps by matches.
  geometry::Pose2 previous_by_wheels;         ///< Step by odometry before the last one.
  double previous_duration_s = 0.0;           ///< Its duration; 0: none yet.
  geometry::Pose2 last_by_wheels;             ///< Last step by odometry, uncorrected.
  double last_duration_s = 0.0;               ///< Duration of the last step; 0: none yet.
  double usual_way_m = 0.5;                   ///< Usual way of a step.
  double usual_drive_m = 0.5;                 ///< Usual way of a step that is no turn on the spot.
  double usual_turn_rad = 0.5;                ///< Usual absolute turn of a turn on the spot.
  double usual_share = 0.5;                   ///< Usual share of a scan's points that match.
  Velocity matched_velocity = Velocity::Zero();  ///< Velocity from the last steps between matches.
  Eigen::Vector2d matched_velocity_variance = Eigen::Vector2d::Constant(1e3);
  WheelFactors factors;  ///< Applied to odometry first.
  WheelFactorEstimator estimator;
  double log_odds = 1.0;  ///< Of correct against wrong odometry, by comparisons of scans some way
                          ///< apart [nats].
  double log_odds_of_factors = 0.0;  ///< The same for odometry with the estimator's factors.
  int disbeliefs = 0;  ///< Number of rejections; each raises the threshold for accepting odometry
                       ///< again.
  std::int64_t confirmed_ns = 0;  ///< Last scan whose comparison told the way and confirmed
                                  ///< odometry; 0: none yet.
  double disbelieved_s = 0.0;     ///< Duration of the current rejection.
  bool is_disbelieved = false;    ///< Odometry is not used for predictions until comparisons agree
                                  ///< with it again.
  int recalibrated_scans = 0;  ///< Number of successive scans with kRecalibrated as by far the best
                               ///< explanation.
  std::uint64_t recalibrations = 0;
};

/// Log-odds of odometry against a wide alternative for the motion between two scans [nats],
/// bounded. by_wheels: corrected. by_scans: with the covariance of the match.
double log_odds_of(const geometry::Pose2& by_wheels, const geometry::UncertainPose2& by_scans);

/// Motion between two scans.
struct OdometryComparison {
  geometry::Pose2 by_wheels;                         ///< By odometry, uncorrected.
  geometry::Pose2 as_believed;                       ///< By odometry, with all corrections.
  std::optional<geometry::UncertainPose2> by_scans;  ///< By matching; none if the scans do not
                                                     ///< match.
  double duration_s = 0.0;
  double extra_odds = 0.0;  ///< Additional log-odds of correct odometry, besides the poses [nats].
  std::optional<geometry::Pose2> odom_from_keyframe{};  ///< Pose at the earlier scan, where the
                                                        ///< scans refute that the vehicle stood
                                                        ///< since.
};

/// Where scans come often, a car's turns between them are within the noise of its wheels, such as
/// of coarse encoders, which fits a factor of zero: scans say when it turns. Where they come seldom
/// the factor predicts, and is the smaller the noisier the wheels are.
bool wheels_tell_turns(const OdometryBelief& belief);

OdometryBelief compared(OdometryBelief belief, const OdometryComparison& comparison);

/// True if odometry says that the vehicle stood, and the scans, if they match, say the same:
/// odometry that never moves says so, too.
bool both_stand(const OdometryComparison& comparison);

/// True if the scans tell how far the vehicle came, and odometry says the same.
bool confirms(const OdometryComparison& comparison);

/// Distance, in the base, by which the pose may be off by odometry that is found wrong now and was
/// believed for this long since a comparison confirmed it: as the rate of the error found is
/// constant at most. Zero if the scans did not match.
Eigen::Vector2d unnoticed_error_m(const OdometryComparison& comparison, double unconfirmed_s);

/// True if odometry's velocity (uncorrected) changed from one of the last two steps to this one
/// more than a vehicle's can.
bool has_changed(const OdometryBelief& belief, const geometry::Pose2& by_wheels, double duration_s);

/// After such a change odometry has to be confirmed by comparisons with scans: limits the log-odds
/// that it is right.
OdometryBelief with_changed_wheels(OdometryBelief belief);

/// Whether odometry (uncorrected) says that nothing moved.
bool count_nothing(const geometry::Pose2& by_wheels);

/// State before the first step of odometry that begins to count while the vehicle drives: how fast
/// it was, and how it accelerated, is not known.
OdometryBelief with_first_wheels(OdometryBelief belief);

/// State before the first step of odometry that is read at another time than before: all that was
/// concluded of it is forgotten.
OdometryBelief with_retimed_wheels(OdometryBelief belief, const OdometryBeliefConfig& config);

/// State after a step with this odometry. What wheels were disbelieved for is over when they
/// counted nothing at the last step and count again: comparisons decide anew.
OdometryBelief with_wheels(OdometryBelief belief, const geometry::Pose2& by_wheels,
                           double duration_s);

/// Log-likelihood of a step given the velocity before it, up to a constant, bounded [nats].
double log_likelihood_of_acceleration(const geometry::Pose2& step,
                                      const geometry::Pose2& at_velocity, double duration_s);

inline constexpr double kGapSteps = 10.0;  ///< Usual steps; a longer one may be a gap.

/// Time between scans after a gap: learned with a bound.
double step_after_gap_s(double usual_step_s, const OdometryBeliefConfig& config);

/// State after one more step; before_from_base: by matches, if any.
OdometryBelief moved(OdometryBelief belief, StepExplanation explanation, double duration_s,
                     const std::optional<geometry::Pose2>& before_from_base,
                     const MotionModelConfig& motion, const OdometryBeliefConfig& config);

}  // namespace slammot::sensing
