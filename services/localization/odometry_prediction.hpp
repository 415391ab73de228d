#pragma once

#include <cmath>
#include <cstdint>
#include <optional>
#include <vector>

#include "common/sensing/motion_model.hpp"
#include "common/sensing/odometry_buffer.hpp"
#include "common/sensing/stamp_guard.hpp"
#include "services/localization/localizer_config.hpp"
#include "services/localization/scan_match.hpp"

namespace slammot::localization {

/// What a step was predicted by.
enum class StepSource {
  kOdometry,           ///< Wheels, corrected by their calibration, or known to stand.
  kVelocityThisOnce,   ///< Constant velocity: wheels were not believed, or spoke at one end of the step only.
  kVelocityAlone,      ///< Constant velocity: there are no wheels.
};

/// Motion from the last scan to the one at hand, as predicted before that is matched. Poses in odom.
struct Step {
  std::int64_t stamp_ns = 0;                        ///< Of the scan at hand.
  double duration_s = 0.0;                          ///< Since the last one; 0 for another scanner's at the same time.
  StepSource source = StepSource::kVelocityAlone;
  std::optional<geometry::Pose2> wheel_from_base;   ///< At the stamp.
  geometry::UncertainPose2 odom_from_base_before;   ///< Estimate at the last scan.
  sensing::MotionEstimate after;                    ///< Prediction at the stamp; the prior of the match.
  geometry::Pose2 before_from_base;                 ///< The step as predicted.
  double speed_mps = 0.0;                           ///< Forward, during the step.
  double yaw_rate_radps = 0.0;
  double stood_s = 0.0;                             ///< How long wheels have reported no motion;
  bool is_standing = false;                         ///< long enough for the vehicle to stand.
  bool has_doubted_wheels = false;                  ///< They reported a motion that the vehicle cannot have made.
  bool is_gap = false;                              ///< Longer than longest_step_s.
  bool last_was_sampled = false;                    ///< The last match left some direction to the prediction.

  bool is_by_wheels() const { return source == StepSource::kOdometry; }
  geometry::UncertainPose2 prior() const { return after.uncertain_pose(); }
};

/// The step as the match has it: pose of the base at the scan, in that at the last one.
inline geometry::Pose2 matched_step(const Step& step, const ScanMatch& match) {
  return geometry::inverse(step.odom_from_base_before.pose) * match.odom_from_base.pose;
}

/// Predicts the pose of the next scan by odometry, decides how far it is believed, and learns its calibration and the
/// offset of its stamps from the matches. For each scan after the first: predict(), match, observe(). Without odometry, or
/// where it is not believed, the velocity of the estimate predicts.
class OdometryPrediction {
 public:
  /// The scan before the one at hand.
  struct LastScan {
    std::int64_t stamp_ns = 0;
    bool has_wheels = false;
    geometry::Pose2 wheel_from_base;
    bool knows_velocity = false;    ///< Not at the first scan.
    bool was_sampled = false;       ///< Its match left some direction to the prediction.
    double speed_mps = 0.0;
    double yaw_rate_radps = 0.0;
    bool doubted_wheels = false;    ///< What they said last was a jump.
    double trusted_s = 0.0;         ///< Time since then.
    double stood_s = 0.0;           ///< How long wheels have reported no motion.
  };

  /// All that predict() and observe() change; what is kept of odometry samples is not in it.
  struct State {
    sensing::MotionEstimate estimate;               ///< Of one clock for scans and odometry, until applies_stamp_offset.
    sensing::MotionEstimate with_stamp_offset;      ///< Of the same motion, until then: what it would be with the offset learned.
    bool applies_stamp_offset = false;
    std::optional<LastScan> last;                   ///< None before the first scan.
  };

  explicit OdometryPrediction(const LocalizerConfig& config);

  /// Samples may come late or twice; stamps far ahead of all before wait for a second one that agrees.
  void add(const sensing::Odometry& sample);

  /// Whether waiting for more odometry could still improve the prediction at the stamp.
  bool reaches(std::int64_t stamp_ns) const { return odometry_.reaches(stamp_ns); }

  /// The first scan. The pose is the origin of odom.
  void begin(std::int64_t stamp_ns);

  /// The step from the last scan to the stamp, not before it. Changes nothing.
  Step predict(std::int64_t stamp_ns) const;

  /// Feedback: what the match of the step's scan said. The estimate is then that at the scan, which becomes the last one.
  void observe(const Step& step, const ScanMatch& match);

  /// A new map begins at the pose: against it the pose is exact.
  void begin_map_here();

  const State& state() const { return state_; }
  /// Undoes what came since; state is one that state() gave.
  void set_state(const State& state) { state_ = state; }

  const sensing::MotionEstimate& estimate() const { return state_.estimate; }
  const std::optional<LastScan>& last() const { return state_.last; }

  /// By how much later than the scans odometry is stamped, as believed.
  double stamp_offset_s() const { return sensing::stamp_offset_s(of_stamps()); }
  double stamp_offset_sigma_s() const { return std::sqrt(of_stamps().covariance(sensing::kStampOffset, sensing::kStampOffset)); }

  /// Samples that the next steps are compared with, for a checkpoint.
  std::vector<sensing::Odometry> recent_odometry() const;
  /// After a restart: goes on from the state of a checkpoint, with its samples beside those of `before` that came for no scan yet.
  void resume(const State& state, const std::vector<sensing::Odometry>& samples, OdometryPrediction&& before);

 private:
  const sensing::MotionEstimate& of_stamps() const { return state_.applies_stamp_offset ? state_.estimate : state_.with_stamp_offset; }
  std::optional<geometry::Pose2> wheel_from_base_at(std::int64_t stamp_ns) const;
  std::optional<geometry::Pose2> step_by_wheels(const Step& step) const;
  std::optional<geometry::Pose2> wheel_step(std::int64_t stamp_ns, std::int64_t after_ns) const;
  Eigen::Vector3d step_by_stamp_offset(std::int64_t stamp_ns, double offset_s) const;
  bool have_jumped_lately() const;
  bool tells_of_stamps(std::int64_t stamp_ns) const;
  bool is_impossible(const geometry::Pose2& by_wheels, double duration_s) const;
  bool is_doubtful(const geometry::Pose2& by_wheels, double duration_s) const;
  sensing::MotionEstimate doubted_velocity(const geometry::Pose2& by_wheels, double duration_s) const;
  sensing::MotionEstimate moved_by_wheels(const geometry::Pose2& by_wheels, std::int64_t stamp_ns, double duration_s) const;
  void follow_wheels(const geometry::Pose2& by_wheels, Step& step) const;
  void go_on_at_velocity(const sensing::MotionEstimate& before, Step& step) const;
  void learn_stamp_offset(const Step& step, const ScanMatch& match);
  void renew_map(const geometry::Pose2& before_from_base, const ScanMatch& match);
  LastScan last_after(const Step& step, const ScanMatch& match) const;

  LocalizerConfig config_;
  sensing::MotionModelConfig motion_of_one_clock_;  ///< That of the estimate until the stamps' offset is used.
  sensing::StampGuard stamps_;
  sensing::OdometryBuffer odometry_;
  State state_;
};

}  // namespace slammot::localization
