#include "common/sensing/wheel_speed_change.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "common/geometry/squared.hpp"

namespace slammot::sensing {

using geometry::squared;

bool WheelSpeedChange::is_sound() const {
  return size_ >= 0.0 && size_ <= static_cast<double>(kMost) &&
         std::ranges::all_of(steps_, [](const Step& step) {
           return std::isfinite(step.middle_s) && std::isfinite(step.speed_mps);
         });
}

/// Of the mean of the last steps from the line; zero where it is within the noise of the steps, as
/// far as the line shows that.
double WheelSpeedChange::departure_mps() const {
  constexpr double kSigmas = 4.0;
  double mean_s = 0.0;
  double mean_mps = 0.0;
  for (std::size_t i = 0; i < kBefore; ++i) {
    mean_s += steps_[i].middle_s / kBefore;
    mean_mps += steps_[i].speed_mps / kBefore;
  }
  double of_time_s2 = 0.0;
  double of_both_m = 0.0;
  double of_speed_m2ps2 = 0.0;
  for (std::size_t i = 0; i < kBefore; ++i) {
    const double apart_s = steps_[i].middle_s - mean_s;
    const double apart_mps = steps_[i].speed_mps - mean_mps;
    of_time_s2 += squared(apart_s);
    of_both_m += apart_s * apart_mps;
    of_speed_m2ps2 += squared(apart_mps);
  }
  if (of_time_s2 <= 0.0) return 0.0;
  const double slope_mps2 = of_both_m / of_time_s2;
  const double noise_m2ps2 =
      std::max(0.0, of_speed_m2ps2 - slope_mps2 * of_both_m) / (kBefore - 2);
  double last_s = 0.0;
  double last_mps = 0.0;
  for (std::size_t i = kBefore; i < kMost; ++i) {
    last_s += steps_[i].middle_s / kLast;
    last_mps += steps_[i].speed_mps / kLast;
  }
  const double variance_m2ps2 =
      noise_m2ps2 * (1.0 / kLast + 1.0 / kBefore + squared(last_s - mean_s) / of_time_s2);
  const double departure_mps = last_mps - mean_mps - slope_mps2 * (last_s - mean_s);
  return squared(departure_mps) > squared(kSigmas) * variance_m2ps2 ? departure_mps : 0.0;
}

std::optional<double> WheelSpeedChange::observe(double speed_mps, double duration_s) {
  constexpr double kLeast_mps = 0.5;
  std::ranges::rotate(steps_, steps_.begin() + 1);
  for (Step& step : steps_) step.middle_s -= duration_s;
  steps_.back() = {.middle_s = -0.5 * duration_s, .speed_mps = speed_mps};
  size_ = std::min(size_ + 1.0, static_cast<double>(kMost));
  if (size_ < static_cast<double>(kMost)) return std::nullopt;
  const double changed_mps = departure_mps();
  if (std::abs(changed_mps) < kLeast_mps) return std::nullopt;
  begin_anew();
  return changed_mps;
}

}  // namespace slammot::sensing
