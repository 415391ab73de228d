#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "common/geometry/uncertain_pose2.hpp"
#include "common/sensing/motion_model.hpp"
#include "common/sensing/step_history.hpp"

namespace slammot::sensing {

/// Explanations of a step between two scans: the components of the mixture that predicts the pose of a scan.
enum class StepExplanation : std::uint8_t {
  kWheels,        ///< Odometry as calibrated so far.
  kRoughWheels,   ///< The same mean with a multiple of the noise: the heavy tail of odometry.
  kRecalibrated,  ///< Odometry with the way and turn factors that recent matches suggest.
  kOther,         ///< Odometry tells nothing: constant velocity, or anywhere within reach where no time is known.
};
inline constexpr std::size_t kStepExplanations = 4;
using ExplanationWeights = std::array<double, kStepExplanations>;

inline constexpr std::size_t index_of(StepExplanation explanation) { return static_cast<std::size_t>(explanation); }

struct OdometryBeliefConfig {
  bool enabled = true;
  double rough_prior = 0.03;                ///< After a change: share of kRoughWheels,
  double recalibrated_prior = 0.01;         ///< of kRecalibrated,
  double other_prior = 0.003;               ///< and of kOther.
  double rough_sigmas = 4.0;                ///< Noise of kRoughWheels, times that of kWheels.
  double share_nats = 60.0;                 ///< Log-likelihood of all points matched against none, if points erred independently.
  double usual_step_memory = 0.1;           ///< Weight of one step in the usual time between scans.
  double reach_m = 0.3;                     ///< kOther without time: one sigma of the position.
  double repeat_rad = 0.12;                 ///< One sigma of the turn of a step that is like one before.
  double way_at_start = 1.0;                ///< Way by scans over way by odometry, as far as it is known before the first scan.
};

/// Log of the marginal likelihood of a scan [nats], up to a constant of the scan: integral of prediction times
/// exp(-1/2 (x - optimum)' information (x - optimum)). information: 3x3 over (x [m], y [m], heading [rad]) in the
/// prediction's frame, may be singular.
double log_marginal_likelihood(const geometry::UncertainPose2& prediction, const geometry::Pose2& optimum, const geometry::Matrix3& information);

/// Pose at which the scan's own likelihood is highest, from a match (maximum a posteriori) that had the prediction for its
/// prior. Directions in which the scan holds no information stay where the match put them.
geometry::Pose2 scan_optimum(const geometry::UncertainPose2& prediction, const geometry::Pose2& matched, const geometry::Matrix3& information);

/// Weights before the next scan, from those after the last one.
ExplanationWeights predicted(const ExplanationWeights& weights, const OdometryBeliefConfig& config);

/// Bayes' rule. -infinity for an explanation that is not available; at least one is.
ExplanationWeights updated(const ExplanationWeights& weights, const std::array<double, kStepExplanations>& log_likelihoods);

StepExplanation most_likely(const ExplanationWeights& weights);

/// Way factor, turn factor and turn bias of odometry by recursive least squares on matched steps.
struct WheelFactors {
  double way = 1.0;                 ///< Way by matches over way by odometry.
  double turn = 1.0;                ///< The same of turns.
  double turn_bias_radps = 0.0;     ///< Turn by matches that odometry does not show.
};

class WheelFactorEstimator {
 public:
  WheelFactorEstimator() = default;
  /// As far as they are known beforehand.
  explicit WheelFactorEstimator(const WheelFactors& at_start) : factors_(at_start) {}

  /// One step as odometry has it (not corrected), and as matches have it.
  void observe(const geometry::Pose2& by_wheels, const geometry::Pose2& by_matches, double duration_s);

  /// Whether way and turn are known well enough to predict with.
  bool is_known() const;
  const WheelFactors& factors() const { return factors_; }
  double way_sigma() const;
  double turn_sigma() const;
  const Eigen::Matrix2d& turn_covariance() const { return turn_covariance_; }
  int steps() const { return steps_; }

  /// Passes each value of the state to the visitor, in a fixed order: for a checkpoint.
  template <typename Visitor>
  void visit(Visitor visit) const { visit(factors_), visit(way_variance_), visit(turn_covariance_), visit(steps_), visit(misfit_); }
  template <typename Visitor>
  void visit(Visitor visit) { visit(factors_), visit(way_variance_), visit(turn_covariance_), visit(steps_), visit(misfit_); }

 private:
  WheelFactors factors_;
  double way_variance_ = 0.25;
  Eigen::Matrix2d turn_covariance_ = Eigen::Vector2d(2.25, 0.01).asDiagonal();
  int steps_ = 0;
  double misfit_ = 1.0;             ///< Mean of the squared innovations of the way, over what was expected of them.
};

/// The step with the factors applied.
geometry::Pose2 corrected(const geometry::Pose2& by_wheels, double duration_s, const WheelFactors& factors);

/// What is believed of odometry from scan to scan.
struct OdometryBelief {
  ExplanationWeights weights{1.0, 0.0, 0.0, 0.0};
  StepExplanation last = StepExplanation::kWheels;     ///< Of the last step.
  double usual_step_s = 0.1;                           ///< Time between scans.
  geometry::Pose2 last_step;                           ///< By the matches.
  StepHistory steps;                                   ///< The same of those before.
  geometry::Pose2 last_by_wheels;                      ///< Last step as odometry had it, not corrected,
  double last_duration_s = 0.0;                        ///< and how long it took; 0: none yet.
  double usual_way_m = 0.5;                            ///< Of a step,
  double usual_drive_m = 0.5;                          ///< and of one that is no turn on the spot.
  double usual_turn_rad = 0.5;                         ///< By which one that is turns, either way.
  double usual_share = 0.5;                            ///< Of the points of a scan that match.
  Velocity matched_velocity = Velocity::Zero();        ///< Of the last steps between matches,
  Eigen::Vector2d matched_velocity_variance = Eigen::Vector2d::Constant(1e3);
  WheelFactors factors;                                ///< Applied to odometry before all else.
  WheelFactorEstimator estimator;
  double log_odds = 1.0;                               ///< Of odometry being right against wrong, by comparisons of scans some way apart [nats].
  double log_odds_of_factors = 0.0;                    ///< The same of odometry with the estimator's factors.
  int disbeliefs = 0;                                  ///< How often it was disbelieved: each asks for more before it is believed again.
  double disbelieved_s = 0.0;                          ///< For how long.
  bool is_disbelieved = false;                         ///< Odometry predicts nothing until comparisons agree with it again.
  int recalibrated_scans = 0;                          ///< In a row for which kRecalibrated was the best explanation by far.
  std::uint64_t recalibrations = 0;
};

/// Log-odds for odometry against another, wide explanation of how far it is between two scans [nats], bounded. by_wheels: corrected;
/// by_scans: with the covariance of what the scans tell.
double log_odds_of(const geometry::Pose2& by_wheels, const geometry::UncertainPose2& by_scans);

/// How far it is between two scans.
struct OdometryComparison {
  geometry::Pose2 by_wheels;                           ///< Not corrected,
  geometry::Pose2 as_believed;                         ///< and with all that is known of odometry applied.
  std::optional<geometry::UncertainPose2> by_scans;    ///< None: they did not match, and odometry is all there is.
  double duration_s = 0.0;
  double extra_odds = 0.0;                             ///< Of odometry being right, beside what the poses say [nats].
};

OdometryBelief compared(OdometryBelief belief, const OdometryComparison& comparison);

/// Whether odometry changed its velocity from the last step to this one (not corrected) as no vehicle does.
bool has_changed(const OdometryBelief& belief, const geometry::Pose2& by_wheels, double duration_s);

/// After a step that odometry had like this.
OdometryBelief with_wheels(OdometryBelief belief, const geometry::Pose2& by_wheels, double duration_s);

/// How likely the vehicle moved by this step, at the velocity before it: log-likelihood up to a constant, bounded [nats].
double log_likelihood_of_acceleration(const geometry::Pose2& step, const geometry::Pose2& at_velocity, double duration_s);

/// After one more step; before_from_base: by the matches, where there was one.
OdometryBelief moved(OdometryBelief belief, StepExplanation explanation, double duration_s, const std::optional<geometry::Pose2>& before_from_base,
                     const MotionModelConfig& motion, const OdometryBeliefConfig& config);

}  // namespace slammot::sensing
