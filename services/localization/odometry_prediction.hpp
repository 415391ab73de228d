#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <optional>
#include <vector>

#include "common/sensing/mean_innovation.hpp"
#include "common/sensing/motion_model.hpp"
#include "common/sensing/odometry_belief.hpp"
#include "common/sensing/odometry_buffer.hpp"
#include "common/sensing/stamp_guard.hpp"
#include "common/sensing/turn_noise.hpp"
#include "common/sensing/wheel_slip.hpp"
#include "common/sensing/wheel_speed_change.hpp"
#include "services/localization/localizer_config.hpp"
#include "services/localization/scan_match.hpp"

namespace slammot::localization {

inline std::int64_t to_ns(double duration_s) {
  return static_cast<std::int64_t>(std::llround(duration_s / 1e-9));
}

/// What a step was predicted by.
enum class StepSource {
  kOdometry,          ///< Wheels, corrected by their calibration, or known to stand.
  kReach,             ///< Anywhere within reach: no odometry, and scans too rare for a velocity.
  kVelocityThisOnce,  ///< Constant velocity: wheels were not believed, or spoke at one end of the
                      ///< step only.
  kVelocityAlone,     ///< Constant velocity: there are no wheels.
};

/// What odometry says of a step.
struct StepWheels {
  std::optional<geometry::Pose2> wheel_from_base;  ///< At the scan at hand.
  geometry::Pose2 uncorrected;                     ///< The step as odometry has it.
  sensing::Velocity gained{0.0, 0.0};              ///< During the sweep, over that of the step.
  double stood_s = 0.0;                            ///< How long it has reported no motion;
  bool is_standing = false;                        ///< long enough for the vehicle to stand.
  bool are_doubted = false;  ///< It reported a motion that the vehicle cannot have made,
  bool have_leapt = false;   ///< and some metres farther than it can drive.
  bool have_begun = false;   ///< It counts for the first time, and at once more than a vehicle sets
                             ///< off with: it was driving before.
  bool have_changed = false;        ///< It changed its velocity as no vehicle does.
  bool are_in_doubt = false;        ///< So it did, or it was not believed at the last scan.
  bool are_overruled = false;       ///< It predicted the step, and another explanation won.
  double turn_variance_rad2 = 0.0;  ///< Noise of its turn beyond that of sound wheels.
};

/// Motion from the last scan to the one at hand, as predicted before that is matched. Poses in
/// odom.
struct Step {
  std::int64_t stamp_ns = 0;      ///< Of the scan at hand.
  double duration_s = 0.0;        ///< Since the last one; 0 for another scanner's at the same time.
  double usual_duration_s = 0.0;  ///< Of the steps before.
  StepSource source = StepSource::kVelocityAlone;
  StepWheels wheels;
  geometry::UncertainPose2 odom_from_base_before;  ///< Estimate at the last scan.
  sensing::MotionEstimate after;     ///< Prediction at the stamp; the prior of the match.
  geometry::Pose2 before_from_base;  ///< The step as predicted.
  double speed_mps = 0.0;            ///< Forward, during the step; during the sweep, where that
                                     ///< is slow and odometry reaches its end.
  double yaw_rate_radps = 0.0;
  bool last_was_sampled = false;  ///< The last match left some direction to the prediction.
  sensing::StepExplanation explanation = sensing::StepExplanation::kWheels;  ///< Which component of
                                                                             ///< the mixture of
                                                                             ///< predictions this
                                                                             ///< is.
  sensing::WheelSlip slip;  ///< Hypotheses of the wheels' slip at the scan at hand, if any.

  /// Whether odometry spoke of the step and was no jump, believed or not.
  bool has_wheels() const { return is_by_wheels() || wheels.are_overruled; }
  bool is_by_wheels() const { return source == StepSource::kOdometry; }
  geometry::UncertainPose2 prior() const { return after.uncertain_pose(); }
};

/// The explanations of one step, odometry as calibrated first. Holds them without allocation.
class StepMixture {
 public:
  StepMixture() = default;
  StepMixture(std::initializer_list<Step> steps) {
    for (const Step& step : steps) push_back(step);
  }

  /// At most kMost.
  void push_back(const Step& step) { steps_.at(size_++) = step; }

  std::size_t size() const { return size_; }
  const Step& front() const { return steps_.front(); }
  Step& front() { return steps_.front(); }
  const Step& operator[](std::size_t i) const { return steps_[i]; }
  auto begin() { return steps_.begin(); }
  auto end() { return steps_.begin() + static_cast<std::ptrdiff_t>(size_); }
  auto begin() const { return steps_.begin(); }
  auto end() const { return steps_.begin() + static_cast<std::ptrdiff_t>(size_); }

 private:
  static constexpr std::size_t kMost = 5;
  std::array<Step, kMost> steps_;
  std::size_t size_ = 0;
};

/// The step as the match has it: pose of the base at the scan, in that at the last one.
inline geometry::Pose2 matched_step(const Step& step, const ScanMatch& match) {
  return geometry::inverse(step.odom_from_base_before.pose) * match.odom_from_base.pose;
}

/// Predicts the pose of the next scan by odometry, decides how far it is believed, and learns its
/// calibration and the offset of its stamps from the matches. For each scan after the first:
/// predict(), match, observe(). Without odometry, or where it is not believed, the velocity of the
/// estimate predicts.
class OdometryPrediction {
 public:
  /// The scan before the one at hand.
  struct LastScan {
    std::int64_t stamp_ns = 0;
    bool has_wheels = false;
    geometry::Pose2 wheel_from_base;
    bool knows_velocity = false;  ///< Not at the first scan.
    bool was_sampled = false;     ///< Its match left some direction to the prediction.
    double speed_mps = 0.0;
    double yaw_rate_radps = 0.0;
    bool doubted_wheels = false;       ///< What they said last was a jump.
    double trusted_s = 0.0;            ///< Time since then.
    double stood_s = 0.0;              ///< How long wheels have reported no motion.
    bool wheels_have_counted = false;  ///< Since the drive began.
  };

  /// What matches say of the heading and of the way beyond the prediction by odometry.
  struct Innovations {
    sensing::MeanInnovation turns;  ///< Error as a turn rate [rad/s].
    sensing::MeanInnovation ways;   ///< Error as a share of the way.
  };

  /// All that predict() and observe() change; what is kept of odometry samples is not in it.
  struct State {
    sensing::MotionEstimate estimate;           ///< Of one clock for scans and odometry, until
                                                ///< applies_stamp_offset.
    sensing::MotionEstimate with_stamp_offset;  ///< Of the same motion, until then: what it would
                                                ///< be with the offset learned.
    bool applies_stamp_offset = false;
    sensing::MotionEstimate with_pivot;  ///< Of the same motion, until applies_pivot: with a
                                         ///< turning point that is not as said.
    bool applies_pivot = false;
    Innovations innovations;
    sensing::TurnNoise turn_noise;
    sensing::WheelSlip slip;
    sensing::WheelSpeedChange speed_change;
    std::optional<LastScan> last;  ///< None before the first scan.
    sensing::OdometryBelief belief;
  };

  explicit OdometryPrediction(const LocalizerConfig& config);

  /// Samples may come late or twice; stamps far ahead of all before wait for a second one that
  /// agrees.
  void add(const sensing::Odometry& sample);

  /// Whether waiting for more odometry could still improve the prediction at the stamp.
  bool reaches(std::int64_t stamp_ns) const { return odometry_.reaches(stamp_ns); }

  /// Odometry at a scan's stamp, by the offset between the clocks as believed.
  std::optional<geometry::Pose2> wheel_from_base_at(std::int64_t stamp_ns) const;

  /// The first scan. The pose is the origin of odom.
  void begin(std::int64_t stamp_ns);

  /// The step from the last scan to the stamp, not before it, of a scan that takes so long. Changes
  /// nothing.
  Step predict(std::int64_t stamp_ns, double sweep_s = 0.0) const;

  /// A step as it is predicted where wheels are doubted, for one by wheels that is far longer than
  /// usual though not impossible; none for any other, or where a velocity predicts.
  std::optional<Step> with_doubted_wheels(const Step& by_wheels) const;

  /// All explanations of a step that odometry predicts, that one first: see
  /// sensing::StepExplanation. Of one that may lead anywhere within reach, that and the steps that
  /// are like those before. Of any other step only it.
  StepMixture explanations(const Step& by_wheels) const;

  /// Motion by odometry, not corrected, with all that is known of it applied.
  geometry::Pose2 as_believed(const geometry::Pose2& by_wheels, double duration_s) const;

  /// Feedback: odometry beside what two scans some way apart tell. Returns by how much the pose may
  /// be off, in the base, where odometry is found wrong now (sensing::unnoticed_error_m); else
  /// zero.
  geometry::Vector2 compare(const sensing::OdometryComparison& comparison);

  /// Odometry is so late from the next step on. What was learned of it before is forgotten: it was
  /// read at the wrong time.
  void retime(double late_s, double sigma_s);

  /// Odometry has these factors from the next step on. What was learned of it before is forgotten:
  /// it was learned with others.
  void rescale(const sensing::WheelFactors& factors);

  /// Feedback: how likely the scan is under each explanation, before observe().
  void weigh(const sensing::ExplanationWeights& weights) { state_.belief.weights = weights; }
  /// Weights of the explanations before the scan at hand.
  sensing::ExplanationWeights weights() const {
    return sensing::predicted(state_.belief.weights, config_.belief);
  }

  /// Feedback: what the match of the step's scan said. The estimate is then that at the scan, which
  /// becomes the last one.
  void observe(const Step& step, const ScanMatch& match);

  /// A new map begins at the pose: against it the pose is exact.
  void begin_map_here() {
    state_.estimate.covariance.topRows<3>().setZero();
    state_.estimate.covariance.leftCols<3>().setZero();
    state_.slip = {};
  }

  const State& state() const { return state_; }
  /// Undoes what came since; state is one that state() gave.
  void set_state(const State& state) { state_ = state; }

  const sensing::MotionEstimate& estimate() const { return state_.estimate; }
  const std::optional<LastScan>& last() const { return state_.last; }
  std::optional<std::int64_t> last_stamp_ns() const {
    return state_.last ? std::optional(state_.last->stamp_ns) : std::nullopt;
  }
  /// Whether a step is so much longer than those before that its way tells of no moment in it, as
  /// after scans in which nothing was in range.
  bool is_gap(const Step& step) const {
    return state_.belief.steps.size() >= kStepsToKnowGaps &&
           step.duration_s > config_.odometry.longest_step_s &&
           step.duration_s > sensing::kGapSteps * step.usual_duration_s;
  }
  bool has_rare_scans() const { return state_.belief.usual_step_s >= sensing::kRareScans_s; }

  /// By how much later than the scans odometry is stamped, as believed.
  double stamp_offset_s() const { return sensing::stamp_offset_s(of_stamps()); }
  double stamp_offset_sigma_s() const {
    return std::sqrt(of_stamps().covariance(sensing::kStampOffset, sensing::kStampOffset));
  }

  /// Samples that the next steps are compared with, for a checkpoint.
  std::vector<sensing::Odometry> recent_odometry() const;
  /// After a restart: goes on from the state of a checkpoint, with its samples beside those of
  /// `before` that came for no scan yet.
  void resume(const State& state, const std::vector<sensing::Odometry>& samples,
              OdometryPrediction&& before);

 private:
  const sensing::MotionEstimate& of_stamps() const {
    return state_.applies_stamp_offset ? state_.estimate : state_.with_stamp_offset;
  }
  std::optional<geometry::Pose2> step_by_wheels(const Step& step) const;
  std::optional<geometry::Pose2> wheel_step(std::int64_t stamp_ns, std::int64_t after_ns) const;
  Eigen::Vector3d step_by_stamp_offset(std::int64_t stamp_ns, double offset_s) const;
  sensing::Velocity gained_in_sweep(const Step& step, const geometry::Pose2& by_wheels,
                                    double sweep_s) const;
  bool have_jumped_lately() const;
  bool tells_of_stamps(std::int64_t stamp_ns) const;
  bool is_impossible(const geometry::Pose2& by_wheels, double duration_s) const;
  bool is_doubtful(const geometry::Pose2& by_wheels, double duration_s) const;
  double usual_steps_in(double duration_s) const;
  sensing::MotionEstimate doubted_velocity(const geometry::Pose2& by_wheels,
                                           double duration_s) const;
  sensing::MotionEstimate moved_by_wheels(const geometry::Pose2& by_wheels, std::int64_t stamp_ns,
                                          double duration_s) const;
  void follow_wheels(const geometry::Pose2& by_wheels, Step& step) const;
  void follow_slip(const geometry::Pose2& by_wheels, Step& step) const;
  StepMixture slip_hypotheses(const Step& by_wheels) const;
  void observe_slip(const Step& step, const ScanMatch& match);
  void go_on_at_velocity(const sensing::MotionEstimate& before, Step& step) const;
  void go_on_without_wheels(Step& step) const;
  void adopt_wheel_factors();
  void forget_calibration(const sensing::MotionEstimate& fresh);
  sensing::MotionEstimate pivot_at_start() const;
  void take_back_standing(const sensing::OdometryComparison& comparison);
  void learn_wheels(const Step& step, const ScanMatch& match);
  void learn_turn_noise(const Step& step, const ScanMatch& match);
  double turn_variance_rad2(double duration_s) const;
  sensing::WheelStep turned_as_likely(sensing::WheelStep by_wheels) const;
  void learn_stamp_offset(const Step& step, const ScanMatch& match);
  void doubt_calibration(const Step& step, const ScanMatch& match);
  void learn_pivot(const Step& step, const ScanMatch& match);
  void renew_map(const geometry::Pose2& before_from_base, const ScanMatch& match);
  double unconfirmed_s(const sensing::OdometryComparison& comparison) const;
  LastScan last_after(const Step& step, const ScanMatch& match) const;

  static constexpr std::size_t kStepsToKnowGaps = 10;

  LocalizerConfig config_;
  sensing::MotionModelConfig motion_of_one_clock_;  ///< That of the estimate until the stamps'
                                                    ///< offset is used.
  sensing::StampGuard stamps_;
  sensing::OdometryBuffer odometry_;
  State state_;
};

}  // namespace slammot::localization
