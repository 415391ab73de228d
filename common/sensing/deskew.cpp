#include "common/sensing/deskew.hpp"

#include <cmath>

namespace slammot::sensing {

void deskew(const LaserScan& scan, double speed_mps, double yaw_rate_radps, std::vector<geometry::Vector2>& points_in_base_m) {
  const Scanner& scanner = scan.scanner;
  const std::size_t beam_count = scan.range_m.size();
  points_in_base_m.resize(beam_count);
  for (std::size_t beam = 0; beam < beam_count; ++beam) {
    const float range_m = scan.range_m[beam];
    if (!is_echo(range_m, scanner.max_range_m)) {
      points_in_base_m[beam] = scanner.base_from_laser.translation_m();
      continue;
    }
    const double delay_s = beam_delay_s(scanner, beam, beam_count);
    const double turned_rad = yaw_rate_radps * delay_s;
    const double moved_m = speed_mps * delay_s;
    const double mount_rad = scanner.base_from_laser.heading_rad;
    const double direction_rad = beam_angle_rad(scanner, beam) + mount_rad + turned_rad;
    const geometry::Vector2 laser_m = geometry::Pose2{moved_m * std::cos(0.5 * turned_rad), moved_m * std::sin(0.5 * turned_rad), turned_rad} *
                                      scanner.base_from_laser.translation_m();
    points_in_base_m[beam] = laser_m + static_cast<double>(range_m) * geometry::Vector2(std::cos(direction_rad), std::sin(direction_rad));
  }
}

}  // namespace slammot::sensing
