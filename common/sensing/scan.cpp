#include "common/sensing/scan.hpp"

namespace slammot::sensing {

bool is_blank(const LaserScan& scan, double period_s) {
  if (scan.range_m.empty()) return true;
  return period_s < kRareScans_s &&
         std::ranges::all_of(scan.range_m, [](float range_m) { return std::isnan(range_m); });
}

bool is_echo(float range_m, double max_range_m) {
  return range_m > 0.0F && static_cast<double>(range_m) < max_range_m;  // false for NaN
}

double beam_angle_rad(const Scanner& scanner, std::size_t beam) {
  return scanner.first_beam_rad + static_cast<double>(beam) * scanner.beam_step_rad;
}

double beam_delay_s(const Scanner& scanner, std::size_t beam, std::size_t beam_count) {
  return beam_delay_s(scanner.sweep_s, beam, beam_count);
}

double beam_delay_s(double sweep_s, std::size_t beam, std::size_t beam_count) {
  if (beam_count < 2) return 0.0;
  return sweep_s * static_cast<double>(beam) / static_cast<double>(beam_count - 1);
}

}  // namespace slammot::sensing
