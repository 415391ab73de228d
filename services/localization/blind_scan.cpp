#include "services/localization/blind_scan.hpp"

#include <algorithm>
#include <cmath>

namespace slammot::localization {
namespace {

constexpr std::size_t kFewestEchoes = 10;  // more are matched
constexpr std::size_t kTimesAsMany = 10;

std::size_t echoes_in(const sensing::LaserScan& scan) {
  return static_cast<std::size_t>(std::ranges::count_if(scan.range_m, [&](float range_m) {
    return sensing::is_echo(range_m, scan.scanner.max_range_m);
  }));
}

}  // namespace

bool is_blind(const sensing::LaserScan& scan, const geometry::Pose2& odom_from_base,
              const LocalMap& map) {
  const std::size_t echoes = echoes_in(scan);
  if (echoes >= kFewestEchoes) return false;
  const geometry::Pose2 odom_from_laser = odom_from_base * scan.scanner.base_from_laser;
  const geometry::Vector2 origin_m = odom_from_laser.translation_m();
  const double max_range_m = scan.scanner.max_range_m;
  const std::size_t enough = kTimesAsMany * std::max<std::size_t>(echoes, 1);
  std::size_t expected = 0;
  for (std::size_t beam = 0; beam < scan.range_m.size() && expected < enough; ++beam) {
    const double angle_rad = sensing::beam_angle_rad(scan.scanner, beam);
    const geometry::Vector2 towards_m =
        odom_from_laser *
        geometry::Vector2(max_range_m * std::cos(angle_rad), max_range_m * std::sin(angle_rad));
    const float range_m = map.expected_range_m(origin_m, towards_m, max_range_m);
    expected += sensing::is_echo(range_m, max_range_m) ? 1 : 0;
  }
  return expected >= enough;
}

}  // namespace slammot::localization
