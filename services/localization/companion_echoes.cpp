#include "services/localization/companion_echoes.hpp"

#include <algorithm>

namespace slammot::localization {

const std::vector<std::size_t>& CompanionEchoes::of(
    const sensing::LaserScan& scan, const std::optional<geometry::Pose2>& wheel_from_base) {
  auto found = std::ranges::find(scanners_, scan.scanner.scanner_id, &Scanner::scanner_id);
  if (found == scanners_.end())
    found = scanners_.insert(scanners_.end(), {scan.scanner.scanner_id, {}, {}});
  const geometry::Pose2 moved = found->wheel_from_base && wheel_from_base
                                    ? geometry::inverse(*found->wheel_from_base) * *wheel_from_base
                                    : geometry::Pose2{};
  found->wheel_from_base = wheel_from_base;
  return found->companions.observe({scan.range_m, scan.scanner.first_beam_rad,
                                    scan.scanner.beam_step_rad, scan.scanner.max_range_m},
                                   moved);
}

}  // namespace slammot::localization
