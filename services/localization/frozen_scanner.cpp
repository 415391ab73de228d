#include "services/localization/frozen_scanner.hpp"

#include <algorithm>
#include <cmath>

namespace slammot::localization {
namespace {

constexpr double kMoved_m = 0.03;  // more changes some reading of a scanner that counts centimetres
constexpr double kMoved_rad = 0.03;
constexpr std::size_t kEchoesToCompare = 10;

bool has_moved(const geometry::Pose2& first, const geometry::Pose2& now) {
  const geometry::Pose2 moved = geometry::inverse(first) * now;
  return std::hypot(moved.x_m, moved.y_m) > kMoved_m || std::abs(moved.heading_rad) > kMoved_rad;
}

/// Scans in the open without an echo are all the same.
bool has_echoes(const sensing::LaserScan& scan) {
  std::size_t echoes = 0;
  return std::ranges::any_of(scan.range_m, [&](float range_m) {
    echoes += sensing::is_echo(range_m, scan.scanner.max_range_m) ? 1 : 0;
    return echoes >= kEchoesToCompare;
  });
}

}  // namespace

bool FrozenScanner::repeats(const sensing::LaserScan& scan,
                            const std::optional<geometry::Pose2>& wheel_from_base) {
  const auto found = std::ranges::find(last_, scan.scanner.scanner_id, &Readings::scanner_id);
  if (found == last_.end()) {
    last_.push_back({scan.scanner.scanner_id, scan.range_m, wheel_from_base});
    return false;
  }
  if (found->range_m != scan.range_m || !has_echoes(scan)) {
    found->range_m = scan.range_m;
    found->wheel_from_base = wheel_from_base;
    return false;
  }
  return wheel_from_base && found->wheel_from_base &&
         has_moved(*found->wheel_from_base, *wheel_from_base);
}

}  // namespace slammot::localization
