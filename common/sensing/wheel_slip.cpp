#include "common/sensing/wheel_slip.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>

#include "common/geometry/squared.hpp"

namespace slammot::sensing {
namespace {

using geometry::Matrix3;
using geometry::Pose2;
using geometry::squared;
using geometry::UncertainPose2;

constexpr double kSlipWalk_mps = 0.2;  // per sqrt(s)
constexpr double kLongestUndecided_s = 1.0;
constexpr double kLeastVariance = 1e-6;  // [m^2/s^2] of a slip that is estimated, despite rounding

/// The pose, known less well along the way.
UncertainPose2 widened_ahead(UncertainPose2 pose, double by_m) {
  const geometry::Vector2 ahead(std::cos(pose.pose.heading_rad), std::sin(pose.pose.heading_rad));
  pose.covariance.topLeftCorner<2, 2>() += squared(by_m) * ahead * ahead.transpose();
  return pose;
}

/// The slip is over: the wheels are right from here on.
SlipHypothesis ended(SlipHypothesis hypothesis) {
  hypothesis.slip_mps = hypothesis.slip_variance = 0.0;
  hypothesis.pose_with_slip.setZero();
  return hypothesis;
}

}  // namespace

SlipHypothesis moved(const SlipHypothesis& before, const UncertainPose2& before_from_base,
                     double duration_s) {
  SlipHypothesis after = before;
  Pose2 step = before_from_base.pose;
  step.x_m -= before.slip_mps * duration_s;
  const Pose2& pose = before.odom_from_base.pose;
  const Matrix3 by_before = geometry::compound_jacobian_first(pose, step);
  const Matrix3 by_step = geometry::compound_jacobian_second(pose);
  const Eigen::Vector3d by_slip = -duration_s * by_step.col(0);
  const Eigen::Vector3d cross = by_before * before.pose_with_slip;
  const Matrix3 mixed = cross * by_slip.transpose();
  after.odom_from_base = {
      pose * step, by_before * before.odom_from_base.covariance * by_before.transpose() +
                       by_step * before_from_base.covariance * by_step.transpose() + mixed +
                       mixed.transpose() + before.slip_variance * by_slip * by_slip.transpose()};
  after.pose_with_slip = cross + before.slip_variance * by_slip;
  if (!before.is_none()) after.slip_variance += squared(kSlipWalk_mps) * duration_s;
  return after;
}

SlipHypothesis matched(const SlipHypothesis& predicted, const UncertainPose2& odom_from_base) {
  SlipHypothesis after = predicted;
  after.odom_from_base = odom_from_base;
  if (predicted.is_none()) return after;
  const Matrix3& prior = predicted.odom_from_base.covariance;
  const Eigen::Vector3d gain = prior.ldlt().solve(predicted.pose_with_slip);
  const Eigen::Vector3d missed =
      geometry::difference(odom_from_base.pose, predicted.odom_from_base.pose);
  after.slip_mps += gain.dot(missed);
  const double told_variance = gain.dot((prior - odom_from_base.covariance) * gain);
  after.slip_variance = std::max(predicted.slip_variance - told_variance, kLeastVariance);
  after.pose_with_slip = odom_from_base.covariance * gain;
  return after;
}

std::size_t WheelSlip::likeliest(double none_more_nats) const {
  const auto log_weight = [&](const SlipHypothesis& one) {
    return one.log_weight + (one.is_none() ? none_more_nats : 0.0);
  };
  std::size_t best = 0;
  for (std::size_t i = 1; i < size(); ++i)
    if (log_weight(hypotheses_[i]) > log_weight(hypotheses_[best])) best = i;
  return best;
}

bool WheelSlip::keeps_map_as_it_is() const {
  constexpr double kKnown_mps = 0.2;
  if (!is_active() || undecided_s_ > kLongestUndecided_s) return false;
  return size() > 1 || hypotheses_[0].slip_variance > squared(kKnown_mps);
}

void WheelSlip::push_back(const SlipHypothesis& hypothesis) {
  hypotheses_[size()] = hypothesis;
  size_ += 1.0;
}

void WheelSlip::keep_only(std::size_t kept) {
  hypotheses_[0] = hypotheses_[kept];
  hypotheses_[0].log_weight = 0.0;
  size_ = 1.0;
}

WheelSlip WheelSlip::changed(const UncertainPose2& odom_from_base, double by_mps,
                             double within_s) const {
  constexpr double kLeastSigma_mps = 0.3;
  constexpr double kSigmaShare = 0.2;
  WheelSlip after;
  SlipHypothesis before;
  if (is_active()) before = hypotheses_[likeliest()];
  before.odom_from_base = odom_from_base;
  before.log_weight = 0.0;
  after.push_back(before);
  SlipHypothesis other = before;
  other.odom_from_base = widened_ahead(odom_from_base, by_mps * within_s);
  other.pose_with_slip.setZero();
  other.slip_mps += by_mps;
  other.slip_variance += squared(std::max(kLeastSigma_mps, kSigmaShare * std::abs(by_mps)));
  after.push_back(other);
  if (!before.is_none()) after.push_back(ended(other));
  return after;
}

WheelSlip WheelSlip::moved(const UncertainPose2& before_from_base, double duration_s) const {
  WheelSlip after = *this;
  for (std::size_t i = 0; i < size(); ++i)
    after[i] = sensing::moved(hypotheses_[i], before_from_base, duration_s);
  after.undecided_s_ += duration_s;
  return after;
}

WheelSlip WheelSlip::questioned() const {
  constexpr double kQuestionedAfter_s = 5.0;
  WheelSlip after = *this;
  if (undecided_s_ < kQuestionedAfter_s) return after;
  after.push_back(ended(hypotheses_[0]));
  after.undecided_s_ = 0.0;
  return after;
}

WheelSlip WheelSlip::decided() const {
  constexpr double kLeast_s = 0.15;
  constexpr double kClear_nats = 6.0;
  constexpr double kUndecided_nats = 2.0;  // by which a slip has to be likelier than none at last
  constexpr double kOver_mps = 0.1;
  WheelSlip after = *this;
  if (!is_active()) return after;
  const std::size_t best = likeliest();
  if (undecided_s_ > kLongestUndecided_s) {
    after.keep_only(likeliest(kUndecided_nats));
  } else if (undecided_s_ > kLeast_s) {
    after.size_ = 0.0;
    for (std::size_t i = 0; i < size(); ++i)
      if (hypotheses_[i].log_weight > hypotheses_[best].log_weight - kClear_nats)
        after.push_back(hypotheses_[i]);
  }
  if (after.size() > 1) return after;
  const SlipHypothesis& left = after[0];
  const bool is_over = left.is_none() || (std::abs(left.slip_mps) < kOver_mps &&
                                          left.slip_variance < squared(kOver_mps));
  if (is_over) return {};
  return after.questioned();
}

bool WheelSlip::is_sound() const {
  constexpr double kFastest_mps = 1e3;
  return size_ >= 0.0 && size_ <= static_cast<double>(kMost) && undecided_s_ >= 0.0 &&
         std::ranges::all_of(hypotheses_, [](const SlipHypothesis& one) {
           return std::abs(one.slip_mps) < kFastest_mps && one.slip_variance >= 0.0 &&
                  one.pose_with_slip.allFinite() && one.odom_from_base.covariance.allFinite() &&
                  std::isfinite(one.log_weight) && std::abs(one.odom_from_base.pose.x_m) < 1e7 &&
                  std::abs(one.odom_from_base.pose.y_m) < 1e7 &&
                  std::isfinite(one.odom_from_base.pose.heading_rad);
         });
}

}  // namespace slammot::sensing
