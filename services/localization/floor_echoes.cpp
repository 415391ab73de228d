#include "services/localization/floor_echoes.hpp"

#include <algorithm>

#include "common/sensing/blank_reading.hpp"

namespace slammot::localization {

FloorEchoes::Scanner& FloorEchoes::scanner_of(const sensing::LaserScan& scan) {
  const auto known = std::ranges::find(scanners_, scan.scanner.scanner_id, &Scanner::scanner_id);
  if (known != scanners_.end()) return *known;
  return scanners_.emplace_back(Scanner{scan.scanner.scanner_id, {}, 0, {}});
}

const sensing::LaserScan& FloorEchoes::leave_out(
    const sensing::LaserScan& scan, const std::optional<geometry::Pose2>& wheel_from_base) {
  found_now_.reset();
  Scanner& scanner = scanner_of(scan);
  if (wheel_from_base && !scanner.is_decided()) {
    scanner.survey.add(scan.range_m, *wheel_from_base, false);
    if (scanner.survey.views() >= kLooks[scanner.looks]) look(scanner, scan);
  }
  return without_floor(scan);
}

void FloorEchoes::look(Scanner& scanner, const sensing::LaserScan& scan) {
  ++scanner.looks;
  scanner.floor =
      scanner.survey.conclude({.first_beam_rad = scan.scanner.first_beam_rad,
                               .beam_step_rad = scan.scanner.beam_step_rad,
                               .laser_heading_rad = scan.scanner.base_from_laser.heading_rad,
                               .unit_m = 1.0,
                               .no_echo_m = scan.scanner.max_range_m});
  // A wall along the way stays there, too, until the vehicle has turned often enough.
  if (sensing::lies_beside(scanner.floor.bearing_rad + scan.scanner.base_from_laser.heading_rad))
    scanner.floor = {};
  if (scanner.floor.is_in_view()) {
    found_now_ = scanner.floor;
    scanner.looks = kLooks.size();
  }
  if (scanner.is_decided()) scanner.survey = {};
}

const sensing::LaserScan& FloorEchoes::without_floor(const sensing::LaserScan& scan) {
  const sensing::FloorInView& floor = scanner_of(scan).floor;
  if (!floor.is_left_out()) return scan;
  cleared_ = scan;
  floor.hide(cleared_.range_m, sensing::kTellsNothing);
  return cleared_;
}

}  // namespace slammot::localization
