#include "common/sensing/stray_poses.hpp"

#include <algorithm>
#include <cmath>

#include "common/geometry/order_statistics.hpp"

namespace slammot::sensing {
namespace {

constexpr std::size_t kMostInARow = 2;
constexpr std::size_t kFewest = 20;  // poses that tell what is usual

struct StepSize {
  double way_m = 0.0;
  double turn_rad = 0.0;
};

StepSize step_between(const geometry::Pose2& before, const geometry::Pose2& after) {
  return {(after.translation_m() - before.translation_m()).norm(),
          std::abs(geometry::wrap_angle(after.heading_rad - before.heading_rad))};
}

/// From which on a step away and back is none of the vehicle's.
StepSize impossible_step(std::span<const geometry::Pose2> poses) {
  constexpr StepSize kLeast{0.1, 0.2};  // less is noise, which localization can take
  constexpr double kMostUsual = 0.9;
  constexpr double kFactor = 2.0;
  std::vector<double> ways_m;
  std::vector<double> turns_rad;
  for (std::size_t i = 1; i < poses.size(); ++i) {
    const StepSize step = step_between(poses[i - 1], poses[i]);
    ways_m.push_back(step.way_m);
    turns_rad.push_back(step.turn_rad);
  }
  return {std::max(kLeast.way_m, kFactor * geometry::lower_quantile(std::move(ways_m), kMostUsual)),
          std::max(kLeast.turn_rad,
                   kFactor * geometry::lower_quantile(std::move(turns_rad), kMostUsual))};
}

/// Whether the way to some poses and the way back are both longer than what lies between their
/// neighbours, by as much as is impossible.
bool is_away_and_back(std::span<const geometry::Pose2> poses, const StrayPose& stray,
                      std::size_t last, const StepSize& impossible) {
  const StepSize away = step_between(poses[stray.before], poses[stray.place]);
  const StepSize back = step_between(poses[last], poses[stray.after]);
  const StepSize left = step_between(poses[stray.before], poses[stray.after]);
  return std::min(away.way_m, back.way_m) > left.way_m + impossible.way_m ||
         std::min(away.turn_rad, back.turn_rad) > left.turn_rad + impossible.turn_rad;
}

/// How many poses after this one are stray.
std::size_t stray_after(std::span<const geometry::Pose2> poses, std::size_t before,
                        const StepSize& impossible) {
  for (std::size_t row = 1; row <= kMostInARow && before + row + 1 < poses.size(); ++row) {
    if (is_away_and_back(poses, {before + 1, before, before + row + 1}, before + row, impossible))
      return row;
  }
  return 0;
}

}  // namespace

std::vector<StrayPose> stray_poses(std::span<const geometry::Pose2> wheel_from_base) {
  constexpr std::size_t kMostOneIn = 10;
  std::vector<StrayPose> found;
  if (wheel_from_base.size() < kFewest) return found;
  const StepSize impossible = impossible_step(wheel_from_base);
  for (std::size_t before = 0; before + 2 < wheel_from_base.size();) {
    const std::size_t row = stray_after(wheel_from_base, before, impossible);
    for (std::size_t i = 1; i <= row; ++i) found.push_back({before + i, before, before + row + 1});
    before += row + 1;
  }
  if (found.size() * kMostOneIn > wheel_from_base.size()) found.clear();
  return found;
}

}  // namespace slammot::sensing
