#include "common/sensing/wheel_speed_change.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>

#include "common/geometry/squared.hpp"

namespace slammot::sensing {

using geometry::squared;

bool WheelSpeedChange::is_sound() const {
  return size_ >= 0.0 && size_ <= static_cast<double>(kMost) &&
         std::ranges::all_of(steps_, [](const Step& step) {
           return std::isfinite(step.middle_s) && std::isfinite(step.speed_mps);
         });
}

WheelSpeedChange::Line WheelSpeedChange::line_before() const {
  Line line;
  for (std::size_t i = 0; i < kBefore; ++i) {
    line.middle_s += steps_[i].middle_s / kBefore;
    line.speed_mps += steps_[i].speed_mps / kBefore;
  }
  double of_time_s2 = 0.0;
  double of_both_m = 0.0;
  double of_speed_m2ps2 = 0.0;
  for (std::size_t i = 0; i < kBefore; ++i) {
    const double apart_s = steps_[i].middle_s - line.middle_s;
    const double apart_mps = steps_[i].speed_mps - line.speed_mps;
    of_time_s2 += squared(apart_s);
    of_both_m += apart_s * apart_mps;
    of_speed_m2ps2 += squared(apart_mps);
  }
  if (of_time_s2 <= 0.0) return line;
  line.slope_mps2 = of_both_m / of_time_s2;
  line.noise_m2ps2 = std::max(0.0, of_speed_m2ps2 - line.slope_mps2 * of_both_m) / (kBefore - 2);
  return line;
}

/// How far a step departs from the line, and from the speed before the last steps: the smaller of
/// both, as far as they agree. A vehicle that begins to brake, or comes to a stand, departs far
/// from one of them only.
double WheelSpeedChange::departure_mps(const Step& step, const Line& line) const {
  const auto before = std::span(steps_).subspan<kBefore - kLast, kLast>();
  const double least_mps =
      std::min({before[0].speed_mps, before[1].speed_mps, before[2].speed_mps});
  const double most_mps = std::max({before[0].speed_mps, before[1].speed_mps, before[2].speed_mps});
  const double median_mps =
      before[0].speed_mps + before[1].speed_mps + before[2].speed_mps - least_mps - most_mps;
  const double from_line_mps = step.speed_mps - line.at(step.middle_s);
  const double from_before_mps = step.speed_mps - median_mps;
  if (from_line_mps * from_before_mps <= 0.0) return 0.0;
  return std::abs(from_line_mps) < std::abs(from_before_mps) ? from_line_mps : from_before_mps;
}

std::optional<double> WheelSpeedChange::change_mps() const {
  constexpr double kLeast_mps = 0.52;
  constexpr double kLeastOfStep_mps = 0.3;
  constexpr double kSigmas = 2.2;
  constexpr double kLeastShareAtOnce = 0.65;
  const Line line = line_before();
  double mean_mps = 0.0;
  for (std::size_t i = kBefore; i < kMost; ++i) mean_mps += departure_mps(steps_[i], line) / kLast;
  if (std::abs(mean_mps) < std::max(kLeast_mps, kSigmas * std::sqrt(line.noise_m2ps2)))
    return std::nullopt;
  const double newest_mps = departure_mps(steps_[kMost - 1], line);
  const double second_mps = departure_mps(steps_[kMost - 2], line);
  const double sign = std::copysign(1.0, mean_mps);
  if (sign * newest_mps < kLeastOfStep_mps || sign * second_mps < kLeastOfStep_mps)
    return std::nullopt;
  // A vehicle that brakes departs farther with each step, wheels that slip at once.
  const double oldest_mps = departure_mps(steps_[kBefore], line);
  if (sign * oldest_mps < kLeastShareAtOnce * sign * newest_mps) return std::nullopt;
  return newest_mps;
}

std::optional<double> WheelSpeedChange::observe(double speed_mps, double duration_s) {
  std::rotate(steps_.begin(), steps_.begin() + 1, steps_.end());
  for (Step& step : steps_) step.middle_s -= duration_s;
  steps_.back() = {.middle_s = -0.5 * duration_s, .speed_mps = speed_mps};
  size_ = std::min(size_ + 1.0, static_cast<double>(kMost));
  if (size_ < static_cast<double>(kMost)) return std::nullopt;
  const std::optional<double> changed_mps = change_mps();
  if (changed_mps) begin_anew();
  return changed_mps;
}

}  // namespace slammot::sensing
