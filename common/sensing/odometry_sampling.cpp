#include "common/sensing/odometry_sampling.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

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

}  // namespace slammot::sensing
