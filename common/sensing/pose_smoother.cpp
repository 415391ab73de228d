#include "common/sensing/pose_smoother.hpp"

#include <cmath>

#include <Eigen/Cholesky>

namespace slammot::sensing {
namespace {

constexpr double kReach_s = 0.5;  // samples farther in time are of another motion,
constexpr double kJump_m = 5.0;   // and beyond a jump they are of another start
constexpr double kJump_rad = 1.0;
constexpr int kFewestSamples = 5;

geometry::Pose2 relative(const Odometry& from, const Odometry& to) {
  return geometry::inverse(from.wheel_from_base) * to.wheel_from_base;
}

bool is_jump(const Odometry& a, const Odometry& b) {
  const geometry::Pose2 moved = relative(a, b);
  return std::hypot(moved.x_m, moved.y_m) > kJump_m ||
         std::abs(geometry::wrap_angle(moved.heading_rad)) > kJump_rad;
}

double seconds_between(const Odometry& a, const Odometry& b) {
  return static_cast<double>(b.stamp_ns - a.stamp_ns) * 1e-9;
}

/// Least squares of x, y and heading by 1, t, t^2, in the frame and from the time of one sample.
class Parabola {
 public:
  explicit Parabola(const Odometry& middle) : middle_(middle) { add(middle); }

  void add(const Odometry& sample) {
    const double time_s = seconds_between(middle_, sample);
    const geometry::Pose2 pose = relative(middle_, sample);
    const Eigen::Vector3d powers(1.0, time_s, time_s * time_s);
    normal_ += powers * powers.transpose();
    right_ +=
        powers * Eigen::RowVector3d(pose.x_m, pose.y_m, geometry::wrap_angle(pose.heading_rad));
    ++samples_;
  }

  Odometry at_middle() const {
    if (samples_ < kFewestSamples) return middle_;
    const Eigen::RowVector3d value = normal_.ldlt().solve(right_).row(0);
    return {middle_.stamp_ns,
            middle_.wheel_from_base * geometry::Pose2{value(0), value(1), value(2)}};
  }

 private:
  const Odometry& middle_;
  Eigen::Matrix3d normal_ = Eigen::Matrix3d::Zero();
  Eigen::Matrix3d right_ = Eigen::Matrix3d::Zero();
  int samples_ = 0;
};

}  // namespace

std::optional<Odometry> PoseSmoother::add(const Odometry& sample) {
  samples_.push_back(sample);
  return next(reach_);
}

std::optional<Odometry> PoseSmoother::finish() { return next(0); }

/// after: samples that must have come after it.
std::optional<Odometry> PoseSmoother::next(std::size_t after) {
  if (next_ + after >= samples_.size()) return std::nullopt;
  const Odometry& middle = samples_[next_];
  Parabola parabola(middle);
  const auto take = [&](std::size_t place, std::size_t nearer) {
    const bool is_of_it = std::abs(seconds_between(middle, samples_[place])) <= kReach_s &&
                          !is_jump(samples_[nearer], samples_[place]);
    if (is_of_it) parabola.add(samples_[place]);
    return is_of_it;
  };
  for (std::size_t i = next_; i > 0 && take(i - 1, i);) --i;
  for (std::size_t i = next_ + 1; i < samples_.size() && i <= next_ + reach_ && take(i, i - 1);)
    ++i;
  const Odometry smoothed = parabola.at_middle();
  if (next_ < reach_) ++next_;
  else samples_.pop_front();
  return smoothed;
}

}  // namespace slammot::sensing
