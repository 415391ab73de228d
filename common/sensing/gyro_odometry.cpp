#include "common/sensing/gyro_odometry.hpp"

#include <algorithm>
#include <cmath>

#include "common/geometry/squared.hpp"

namespace slammot::sensing {
namespace {

using geometry::Pose2;

constexpr std::int64_t kLongestGap_ns = 250'000'000;  // between readings that belong together
constexpr std::int64_t kKept_ns = 5'000'000'000;      // odometry may come later than the gyro
constexpr double kStandsWithin_m = 1e-4;              // a step: wheels that stand count nothing
constexpr double kStandsWithin_rad = 1e-4;
constexpr double kStandsAfter_s = 0.5;                  // odometry may come less often than scans
constexpr double kGyroNoise_radps_per_sqrt_hz = 0.002;  // of a mean over a second, engine running
constexpr double kWheelNoise_radpm = 0.004;             // of a step, as heading_noise_per_m
constexpr double kWheelSlip = 0.3;  // share of a turn by which wheels err for about a second
constexpr double kBiasWalk_radps_per_sqrt_s = 1e-4;
constexpr double kGateSigmas = 3.0;         // beyond it the vehicle turns, or the wheels slip
constexpr double kKnownBias_radps = 0.002;  // one sigma
constexpr double kEnough_rad2ps = 0.1;      // of turns: 0.1 rad/s for 10 s

using geometry::squared;
double seconds(std::int64_t duration_ns) { return 1e-9 * static_cast<double>(duration_ns); }

/// The step with another turn: half of what it turns more belongs to the first half of the way.
Pose2 with_turn(const Pose2& step, double turn_rad) {
  const geometry::Vector2 way_m =
      geometry::rotation(0.5 * geometry::wrap_angle(turn_rad - step.heading_rad)) *
      step.translation_m();
  return {way_m.x(), way_m.y(), geometry::wrap_angle(turn_rad)};
}

}  // namespace

double GyroOdometry::bias_sigma_radps() const { return std::sqrt(bias_variance_); }

GyroUse GyroOdometry::use() const {
  return {
      .read_s = read_s_,
      .used_s = used_s_,
      .bias_is_known = bias_sigma_radps() < kKnownBias_radps,
      .bias_radps = bias_radps_,
      .turn_ratio = wheels_by_wheels_ > kEnough_rad2ps ? gyro_by_wheels_ / wheels_by_wheels_ : 0.0};
}

bool GyroOdometry::is_believed() const {
  constexpr double kMostTimes = 2.0;  // wheels that slip are within it
  return bias_sigma_radps() < kKnownBias_radps && wheels_by_wheels_ > kEnough_rad2ps &&
         gyro_by_wheels_ * kMostTimes > wheels_by_wheels_ &&
         gyro_by_wheels_ < kMostTimes * wheels_by_wheels_;
}

void GyroOdometry::compare(double by_wheels_rad, double by_gyro_rad, double duration_s) {
  gyro_by_wheels_ += by_gyro_rad * by_wheels_rad / duration_s;
  wheels_by_wheels_ += by_wheels_rad * by_wheels_rad / duration_s;
}

void GyroOdometry::add(const TurnRate& reading) {
  if (last_ && reading.stamp_ns <= last_->stamp_ns) return;
  const bool is_first = !last_ || reading.stamp_ns - last_->stamp_ns > kLongestGap_ns;
  if (is_first) turned_.clear();
  const double turned_rad =
      is_first ? 0.0
               : turned_.back().turned_rad +
                     reading.yaw_rate_radps * seconds(reading.stamp_ns - last_->stamp_ns);
  turned_.push_back({reading.stamp_ns, turned_rad});
  while (turned_.front().stamp_ns < reading.stamp_ns - kKept_ns) turned_.pop_front();
  last_ = reading;
}

/// None before the first reading and long after the last one. Shortly after the last one the
/// vehicle is taken to go on turning.
std::optional<double> GyroOdometry::turned_until(std::int64_t stamp_ns) const {
  if (turned_.empty() || stamp_ns < turned_.front().stamp_ns) return std::nullopt;
  const auto after = std::ranges::upper_bound(turned_, stamp_ns, {}, &Turned::stamp_ns);
  const Turned& before = *std::prev(after);
  if (after == turned_.end()) {
    if (stamp_ns - before.stamp_ns > kLongestGap_ns) return std::nullopt;
    return before.turned_rad + last_->yaw_rate_radps * seconds(stamp_ns - before.stamp_ns);
  }
  const double fraction =
      seconds(stamp_ns - before.stamp_ns) / seconds(after->stamp_ns - before.stamp_ns);
  return before.turned_rad + fraction * (after->turned_rad - before.turned_rad);
}

/// By the turn of the wheels, which is exact while they stand, good on a straight and poor in a
/// turn.
void GyroOdometry::learn_bias(const Pose2& by_wheels, double by_gyro_rad, double duration_s) {
  bias_variance_ += squared(kBiasWalk_radps_per_sqrt_s) * duration_s;
  const double way_m = std::hypot(by_wheels.x_m, by_wheels.y_m);
  const bool is_still =
      way_m < kStandsWithin_m && std::abs(by_wheels.heading_rad) < kStandsWithin_rad;
  stood_s_ = is_still ? stood_s_ + duration_s : 0.0;
  if (is_still && stood_s_ < kStandsAfter_s) return;
  const double rate_radps = by_gyro_rad / duration_s;
  const double turning_radps =
      std::max(std::abs(by_wheels.heading_rad / duration_s), std::abs(rate_radps - bias_radps_));
  const double slip_radps = is_still ? 0.0 : kWheelSlip * turning_radps;
  const double noise = (squared(kGyroNoise_radps_per_sqrt_hz) + squared(slip_radps)) / duration_s +
                       squared(kWheelNoise_radpm * way_m / duration_s);
  const double innovation_radps = rate_radps - by_wheels.heading_rad / duration_s - bias_radps_;
  const double variance = bias_variance_ + noise;
  if (squared(innovation_radps) > squared(kGateSigmas) * variance) return;
  bias_radps_ += bias_variance_ / variance * innovation_radps;
  bias_variance_ *= noise / variance;
}

double GyroOdometry::turn_of(const Pose2& by_wheels, double by_gyro_rad, double duration_s) {
  learn_bias(by_wheels, by_gyro_rad, duration_s);
  const double turn_rad = by_gyro_rad - bias_radps_ * duration_s;
  compare(by_wheels.heading_rad, turn_rad, duration_s);
  read_s_ += duration_s;
  if (!is_believed()) return by_wheels.heading_rad;
  used_s_ += duration_s;
  return turn_rad;
}

Odometry GyroOdometry::fused(const Odometry& by_wheels) {
  if (!has_readings()) return by_wheels;
  const std::optional<double> turned_rad = turned_until(by_wheels.stamp_ns);
  if (!before_) {
    before_ = Sample{by_wheels, by_wheels, turned_rad};
    return by_wheels;
  }
  const double duration_s = seconds(by_wheels.stamp_ns - before_->by_wheels.stamp_ns);
  Pose2 step = inverse(before_->by_wheels.wheel_from_base) * by_wheels.wheel_from_base;
  if (turned_rad && before_->turned_rad && duration_s > 0.0)
    step = with_turn(step, turn_of(step, *turned_rad - *before_->turned_rad, duration_s));
  const Odometry fused{by_wheels.stamp_ns, before_->fused.wheel_from_base * step};
  before_ = Sample{by_wheels, fused, turned_rad};
  return fused;
}

}  // namespace slammot::sensing
