#include "services/collision_warning/object_motion.hpp"

#include <algorithm>
#include <cmath>

#include "common/filters/kalman.hpp"
#include "common/geometry/pose2.hpp"
#include "common/geometry/squared.hpp"

namespace slammot::collision_warning {
namespace {

using filters::Gaussian;

constexpr double kLongestObjectGapS = 0.5;
// Errors of published velocities, 0.2 m/s along and 0.25 m/s across, last for 0.3 s: as white noise
// of one scan they are sqrt(2 * 0.3 s / 0.027 s) times as large.
constexpr double kSpeedSigmaMps = 1.0;
constexpr double kAcrossSigmaMps = 1.2;
constexpr double kFirstSigmaMps = 1.5;            // of a young track
constexpr double kObjectJerkDensity = 6.0;        // [m^2/s^5]: braking begins within half a second
constexpr double kObjectTurnAccelDensity = 0.05;  // [rad^2/s^3]: steering into a turn
constexpr double kFirstObjectAccelerationSigmaMps2 = 1.0;
constexpr double kFirstObjectYawRateSigmaRadps = 0.1;
constexpr double kLeastCourseSpeedMps = 0.5;  // slower, the velocity has no direction

using geometry::squared;

/// White second derivative, integrated over the step (Bar-Shalom, Li and Kirubarajan 2001, section
/// 6.2.2); `kept` is what is left of the first derivative.
Gaussian<2> after(const Gaussian<2>& state, double dt_s, double density, double kept) {
  Eigen::Matrix2d F;
  F << 1.0, dt_s, 0.0, kept;
  Eigen::Matrix2d Q;
  Q << dt_s * dt_s * dt_s / 3.0, dt_s * dt_s / 2.0, dt_s * dt_s / 2.0, dt_s;
  return filters::kalman_predict<2>(state, F, density * Q);
}

Gaussian<2> measured(const Gaussian<2>& state, double value, double sigma) {
  const Eigen::Matrix<double, 1, 1> z(value);
  const Eigen::Matrix<double, 1, 2> H = Eigen::RowVector2d::UnitX();
  const Eigen::Matrix<double, 1, 1> R(squared(sigma));
  return filters::kalman_update<2, 1>(state, z, H, R).posterior;
}

double course_sigma_rad(double across_mps, double speed_mps) {
  return across_mps / std::max(speed_mps, kLeastCourseSpeedMps);
}

}  // namespace

CourseState ObjectMotion::update(std::int64_t stamp_ns, const flow::TrackedObject& object) {
  const Eigen::Vector2d& velocity_mps = object.velocity_in_odom_mps;
  const double speed_mps = velocity_mps.norm();
  const double course_rad = speed_mps >= kLeastCourseSpeedMps
                                ? std::atan2(velocity_mps.y(), velocity_mps.x())
                                : object.heading_in_odom_rad;
  const double dt_s = stamp_ns_ ? static_cast<double>(stamp_ns - *stamp_ns_) * 1e-9 : 0.0;
  if (!stamp_ns_ || dt_s > kLongestObjectGapS) start(speed_mps, course_rad);
  else if (dt_s > 0.0) follow(dt_s, speed_mps, course_rad);
  stamp_ns_ = stamp_ns;
  if (object.object_class == flow::ObjectClass::kPedestrian)
    return {.course_rad = course_rad, .speed_mps = speed_mps};
  return {geometry::wrap_angle(turn_.mean(0)), speed_mps, along_.mean(1), turn_.mean(1),
          turn_.covariance};
}

void ObjectMotion::start(double speed_mps, double course_rad) {
  along_.mean = {speed_mps, 0.0};
  along_.covariance =
      Eigen::Vector2d(squared(kFirstSigmaMps), squared(kFirstObjectAccelerationSigmaMps2))
          .asDiagonal();
  turn_.mean = {course_rad, 0.0};
  turn_.covariance = Eigen::Vector2d(squared(course_sigma_rad(kFirstSigmaMps, speed_mps)),
                                     squared(kFirstObjectYawRateSigmaRadps))
                         .asDiagonal();
}

void ObjectMotion::follow(double dt_s, double speed_mps, double course_rad) {
  along_ = measured(after(along_, dt_s, kObjectJerkDensity, 1.0), speed_mps, kSpeedSigmaMps);
  turn_ = after(turn_, dt_s, kObjectTurnAccelDensity, std::exp(-dt_s / kTurnS));
  const double course_now_rad =
      turn_.mean(0) + geometry::wrap_angle(course_rad - turn_.mean(0));  // without a jump
  turn_ = measured(turn_, course_now_rad, course_sigma_rad(kAcrossSigmaMps, speed_mps));
}

}  // namespace slammot::collision_warning
