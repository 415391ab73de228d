#pragma once

#include <array>
#include <cstddef>

#include <Eigen/Core>

#include "common/geometry/uncertain_pose2.hpp"

namespace slammot::sensing {

/// Joint Gaussian of the pose and of the wheels' slip: the speed that they count beyond the
/// vehicle's. They must be estimated jointly, since a match tells only how far both together led.
struct SlipHypothesis {
  geometry::UncertainPose2 odom_from_base;
  Eigen::Vector3d pose_with_slip = Eigen::Vector3d::Zero();  ///< Covariance of (x [m], y [m],
                                                             ///< heading [rad]) with slip_mps.
  double slip_mps = 0.0;
  double slip_variance = 0.0;  ///< [m^2/s^2]; 0: the wheels are right, slip_mps is 0.
  double log_weight = 0.0;     ///< Of this hypothesis against the others, up to a constant.

  bool is_none() const { return slip_variance == 0.0; }
};

/// Predicts by a step of odometry (calibrated, with the covariance of the step alone).
SlipHypothesis moved(const SlipHypothesis& before, const geometry::UncertainPose2& before_from_base,
                     double duration_s);

/// Updates the slip with a match whose prior was the hypothesis' pose: conditional Gaussian.
SlipHypothesis matched(const SlipHypothesis& predicted,
                       const geometry::UncertainPose2& odom_from_base);

/// The hypotheses of how fast the wheels slip, few at a time and mostly none: after a sudden change
/// of the wheels' speed it may be the vehicle's, or a slip that begins, changes or ends. Each has a
/// pose of its own, so that each scan is matched under each until the matches of several scans have
/// decided. A value; no memory is allocated.
class WheelSlip {
 public:
  static constexpr std::size_t kMost = 3;

  /// Whether any slip is considered.
  bool is_active() const { return size_ > 0.0; }
  std::size_t size() const { return static_cast<std::size_t>(size_); }
  const SlipHypothesis& operator[](std::size_t i) const { return hypotheses_[i]; }
  SlipHypothesis& operator[](std::size_t i) { return hypotheses_[i]; }
  /// none_more_nats: what is added to the log weight of there being no slip.
  std::size_t likeliest(double none_more_nats = 0.0) const;

  /// Whether scans placed now stay out of the map: the pose is not sure enough, and the map would
  /// confirm its error to the scans that follow. For a second at most.
  bool keeps_map_as_it_is() const;

  /// State after a change of the wheels' speed at the pose estimated now.
  WheelSlip changed(const geometry::UncertainPose2& odom_from_base, double by_mps,
                    double within_s) const;

  /// All hypotheses after a step.
  WheelSlip moved(const geometry::UncertainPose2& before_from_base, double duration_s) const;

  /// State after the scan that they were matched with: what lost is dropped, and a slip that is
  /// over ends.
  WheelSlip decided() const;

  /// Passes each value of the state to the visitor, in a fixed order: for a checkpoint.
  template <typename Visitor>
  void visit(Visitor visit) const {
    visit_parts(*this, visit);
  }
  template <typename Visitor>
  void visit(Visitor visit) {
    visit_parts(*this, visit);
  }

  /// Whether a state that was read can have been one.
  bool is_sound() const;

 private:
  template <typename Slip, typename Visitor>
  static void visit_parts(Slip& slip, Visitor& visit) {
    for (auto& one : slip.hypotheses_) {
      visit(one.odom_from_base.pose), visit(one.odom_from_base.covariance);
      visit(one.pose_with_slip), visit(one.slip_mps), visit(one.slip_variance);
      visit(one.log_weight);
    }
    visit(slip.size_), visit(slip.undecided_s_);
  }
  void push_back(const SlipHypothesis& hypothesis);
  void keep_only(std::size_t kept);
  WheelSlip questioned() const;

  std::array<SlipHypothesis, kMost> hypotheses_{};
  double size_ = 0.0;         ///< How many there are, a whole number.
  double undecided_s_ = 0.0;  ///< Since the last change, or since the slip was questioned.
};

}  // namespace slammot::sensing
