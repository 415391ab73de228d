#include "services/collision_warning/vehicle_motion.hpp"

#include <cmath>

#include "common/filters/kalman.hpp"
#include "common/geometry/squared.hpp"

namespace slammot::collision_warning {
namespace {

using geometry::Pose2;

constexpr double kLongestGapS = 1.0;
constexpr double kPositionSigmaM = 0.01;      // of one matched pose against the next
constexpr double kHeadingSigmaRad = 0.001;    // the same
constexpr double kJerkDensity = 4.0;          // [m^2/s^5]: braking begins within half a second
constexpr double kTurnAccelDensity = 0.02;    // [rad^2/s^3]: steering into a turn
constexpr double kFirstSpeedSigmaMps = 20.0;  // of any road vehicle
constexpr double kFirstAccelerationSigmaMps2 = 2.0;
constexpr double kFirstYawRateSigmaRadps = 0.5;

using geometry::squared;

/// White jerk, integrated over the step (Bar-Shalom, Li and Kirubarajan 2001, section 6.2.3).
filters::Gaussian<3> after(const filters::Gaussian<3>& state, double dt_s) {
  const double t2 = dt_s * dt_s;
  const double t3 = t2 * dt_s;
  Eigen::Matrix3d F;
  F << 1.0, dt_s, 0.5 * t2, 0.0, 1.0, dt_s, 0.0, 0.0, 1.0;
  Eigen::Matrix3d Q;
  Q << t3 * t2 / 20.0, t2 * t2 / 8.0, t3 / 6.0, t2 * t2 / 8.0, t3 / 3.0, t2 / 2.0, t3 / 6.0,
      t2 / 2.0, dt_s;
  return filters::kalman_predict<3>(state, F, kJerkDensity * Q);
}

/// White angular acceleration, integrated over the step (the same, section 6.2.2).
filters::Gaussian<2> after(const filters::Gaussian<2>& state, double dt_s) {
  Eigen::Matrix2d F;
  F << 1.0, dt_s, 0.0, 1.0;
  Eigen::Matrix2d Q;
  Q << dt_s * dt_s * dt_s / 3.0, dt_s * dt_s / 2.0, dt_s * dt_s / 2.0, dt_s;
  return filters::kalman_predict<2>(state, F, kTurnAccelDensity * Q);
}

/// Conditions the state on a measurement of its first component.
template <int N>
filters::Gaussian<N> measured(const filters::Gaussian<N>& state, double value, double sigma) {
  const Eigen::Matrix<double, 1, 1> z(value);
  const Eigen::Matrix<double, 1, N> H = Eigen::Matrix<double, 1, N>::Unit(0);
  const Eigen::Matrix<double, 1, 1> R(squared(sigma));
  return filters::kalman_update<N, 1>(state, z, H, R).posterior;
}

/// Signed length of a step of the base: positive forward.
double step_m(const Pose2& from, const Pose2& to) {
  const double heading_rad =
      from.heading_rad + 0.5 * geometry::wrap_angle(to.heading_rad - from.heading_rad);
  const geometry::Vector2 forward{std::cos(heading_rad), std::sin(heading_rad)};
  return forward.dot(to.translation_m() - from.translation_m());
}

}  // namespace

VehicleState VehicleMotion::update(std::int64_t stamp_ns, const Pose2& odom_from_base) {
  const double dt_s = stamp_ns_ ? static_cast<double>(stamp_ns - *stamp_ns_) * 1e-9 : 0.0;
  if (!stamp_ns_ || dt_s > kLongestGapS) {
    start(stamp_ns, odom_from_base);
  } else if (dt_s > 0.0) {
    follow(dt_s, odom_from_base);
    stamp_ns_ = stamp_ns;
    odom_from_base_ = odom_from_base;
  }
  return {odom_from_base, along_.mean(1), along_.mean(2), turn_.mean(1)};
}

void VehicleMotion::start(std::int64_t stamp_ns, const Pose2& odom_from_base) {
  stamp_ns_ = stamp_ns;
  odom_from_base_ = odom_from_base;
  travelled_m_ = turned_rad_ = 0.0;
  along_ = {};
  along_.covariance.diagonal() << squared(kPositionSigmaM), squared(kFirstSpeedSigmaMps),
      squared(kFirstAccelerationSigmaMps2);
  turn_ = {};
  turn_.covariance.diagonal() << squared(kHeadingSigmaRad), squared(kFirstYawRateSigmaRadps);
}

void VehicleMotion::follow(double dt_s, const Pose2& odom_from_base) {
  travelled_m_ += step_m(odom_from_base_, odom_from_base);
  turned_rad_ += geometry::wrap_angle(odom_from_base.heading_rad - odom_from_base_.heading_rad);
  along_ = measured<3>(after(along_, dt_s), travelled_m_, kPositionSigmaM);
  turn_ = measured<2>(after(turn_, dt_s), turned_rad_, kHeadingSigmaRad);
}

}  // namespace slammot::collision_warning
