#include "common/sensing/odometry_sampling.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "common/geometry/order_statistics.hpp"

namespace slammot::sensing {

void HeldPoses::add(const geometry::Pose2& wheel_from_base) {
  if (last_ == wheel_from_base) {
    ++repeats_;
    return;
  }
  if (std::exchange(last_, wheel_from_base))
    repeats_before_change_.push_back(std::exchange(repeats_, 0));
}

std::size_t HeldPoses::most_scans() const {
  constexpr std::size_t kFewestChanges = 20;
  std::vector<std::size_t> ascending = repeats_before_change_;
  if (ascending.size() < kFewestChanges) return 0;
  std::ranges::sort(ascending);
  if (ascending[ascending.size() / 2] == 0) return 0;
  return 1 + 2 * ascending[ascending.size() * 9 / 10];
}

void PoseNoise::add(const geometry::Pose2& wheel_from_base) {
  constexpr double kMoves_m = 5e-3;
  constexpr double kMost_m = 0.5;  // a jump is not noise
  const auto before = std::exchange(last_, wheel_from_base);
  if (!before) return;
  const geometry::Vector2 step_m = (geometry::inverse(*before) * wheel_from_base).translation_m();
  const auto last_step_m = std::exchange(last_step_m_, step_m);
  if (!last_step_m || step_m.norm() < kMoves_m) return;
  changes_m_ += std::min(std::abs(step_m.y() - last_step_m->y()), kMost_m);
  ++steps_;
}

double PoseNoise::mean_m() const {
  constexpr std::size_t kFewestSteps = 50;
  return steps_ < kFewestSteps ? 0.0 : changes_m_ / static_cast<double>(steps_);
}

namespace {

/// Median of how much a quantity of the steps differs from one to the next beyond a greatest
/// acceleration.
template <typename QuantityOf>
double noise_of(std::span<const Odometry> samples, double most_acceleration,
                QuantityOf quantity_of) {
  constexpr double kMoves_m = 5e-3;
  constexpr std::size_t kFewestSteps = 50;
  std::vector<double> changes;
  double rate_before = 0.0;
  double duration_before_s = 0.0;
  for (std::size_t i = 1; i < samples.size(); ++i) {
    const double duration_s =
        1e-9 * static_cast<double>(samples[i].stamp_ns - samples[i - 1].stamp_ns);
    if (!(duration_s > 0.0)) continue;
    const geometry::Pose2 step =
        geometry::inverse(samples[i - 1].wheel_from_base) * samples[i].wheel_from_base;
    const double rate = quantity_of(step) / duration_s;
    const double change = std::abs(rate - std::exchange(rate_before, rate));
    const double between_s = 0.5 * (duration_s + std::exchange(duration_before_s, duration_s));
    if (i == 1 || std::abs(step.x_m) < kMoves_m) continue;
    changes.push_back(duration_s * std::max(0.0, change - most_acceleration * between_s));
  }
  if (changes.size() < kFewestSteps) return 0.0;
  return geometry::upper_median_in_place(changes);
}

}  // namespace

double forward_noise_m(std::span<const Odometry> samples) {
  constexpr double kAcceleration_mps2 = 5.0;
  return noise_of(samples, kAcceleration_mps2,
                  [](const geometry::Pose2& step) { return step.x_m; });
}

double turn_noise_rad(std::span<const Odometry> samples) {
  constexpr double kAcceleration_radps2 = 5.0;
  return noise_of(samples, kAcceleration_radps2,
                  [](const geometry::Pose2& step) { return step.heading_rad; });
}

}  // namespace slammot::sensing
