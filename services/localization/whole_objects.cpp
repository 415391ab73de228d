#include "services/localization/whole_objects.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "common/matching/body.hpp"
#include "common/sensing/drop_outs.hpp"

namespace slammot::localization {

void WholeObjects::find(const sensing::LaserScan& scan,
                        std::span<const geometry::Vector2> points_in_base_m, double min_range_m,
                        double widest_m) {
  const std::size_t count = scan.range_m.size();
  of_beam_.assign(count, {});
  if (widest_m <= 0.0) return;
  reach_.add(scan);
  sensing::mark_drop_outs(scan, may_be_drop_out_);
  const double reach_m = reach_.reach_m(scan.scanner.scanner_id) - widest_m;
  const geometry::Vector2 laser_m = scan.scanner.base_from_laser.translation_m();
  const auto has_echo = [&](std::size_t beam) {
    return sensing::is_echo(scan.range_m[beam], scan.scanner.max_range_m);
  };
  const auto is_point = [&](std::size_t beam) {
    return has_echo(beam) && scan.range_m[beam] >= min_range_m;
  };
  const auto from_laser_m = [&](std::size_t beam) -> geometry::Vector2 {
    return points_in_base_m[beam] - laser_m;
  };
  const auto ends_behind = [&](std::size_t beam, std::size_t of_object) {
    return has_echo(beam) ? scan.range_m[beam] > scan.range_m[of_object] : !may_be_drop_out_[beam];
  };
  for (std::size_t first = 0, end = 0; first < count; first = end) {
    end = first + 1;
    if (!is_point(first)) continue;
    while (end < count && is_point(end) &&
           matching::continues_body(from_laser_m(first), from_laser_m(end - 1), from_laser_m(end),
                                    2.0 * widest_m))
      ++end;
    const bool has_both_sides = first > 0 && end < count;
    if (!has_both_sides || !ends_behind(first - 1, first) || !ends_behind(end, end - 1)) continue;
    const double range_m = std::max(from_laser_m(first).norm(), from_laser_m(end - 1).norm());
    const double width_m = (from_laser_m(end - 1) - from_laser_m(first)).norm() +
                           std::abs(scan.scanner.beam_step_rad) * range_m;
    if (width_m > widest_m || range_m > reach_m) continue;
    std::fill_n(std::next(of_beam_.begin(), static_cast<std::ptrdiff_t>(first)), end - first,
                Object{.width_m = width_m, .points = static_cast<double>(end - first)});
  }
}

}  // namespace slammot::localization
