#include "common/sensing/deskew.hpp"

#include "common/sensing/turning_direction.hpp"

namespace slammot::sensing {

void deskew(const LaserScan& scan, double speed_mps, double yaw_rate_radps,
            std::vector<geometry::Vector2>& points_in_base_m) {
  const Scanner& scanner = scan.scanner;
  const std::size_t beam_count = scan.range_m.size();
  points_in_base_m.resize(beam_count);
  const double step_s = beam_count > 1 ? beam_delay_s(scanner, 1, beam_count) : 0.0;
  const geometry::Vector2 mount_m = scanner.base_from_laser.translation_m();
  TurningDirection beam_in_base(beam_angle_rad(scanner, 0) + scanner.base_from_laser.heading_rad,
                                scanner.beam_step_rad + yaw_rate_radps * step_s);
  TurningDirection half_turn(0.0, 0.5 * yaw_rate_radps * step_s);
  for (std::size_t beam = 0; beam < beam_count;
       ++beam, beam_in_base.advance(), half_turn.advance()) {
    const float range_m = scan.range_m[beam];
    if (!is_echo(range_m, scanner.max_range_m)) {
      points_in_base_m[beam] = mount_m;
      continue;
    }
    const double moved_m = speed_mps * step_s * static_cast<double>(beam);
    const geometry::Vector2 half = half_turn.now();
    const double cosine = half.x() * half.x() - half.y() * half.y();
    const double sine = 2.0 * half.x() * half.y();
    // By coordinates: assembling a vector from scalars stalls the vector addition.
    const double laser_x_m = moved_m * half.x() + (cosine * mount_m.x() - sine * mount_m.y());
    const double laser_y_m = moved_m * half.y() + (sine * mount_m.x() + cosine * mount_m.y());
    const geometry::Vector2 towards = beam_in_base.now();
    points_in_base_m[beam] = {laser_x_m + static_cast<double>(range_m) * towards.x(),
                              laser_y_m + static_cast<double>(range_m) * towards.y()};
  }
}

}  // namespace slammot::sensing
