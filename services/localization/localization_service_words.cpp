// What LocalizationService says in its log and status while it drives.
#include <cmath>

#include "common/app/log.hpp"
#include "services/localization/localization_service.hpp"

namespace slammot::localization {

void LocalizationService::tell_whereabouts(bool was_lost, std::uint64_t astray_before) {
  if (localizer_.counters().map.astray > astray_before) {
    app::log_warn(
        "did not find itself: submap {} is tied to nothing until loop closing finds its place",
        localizer_.local_map().submap_id().value);
  } else if (localizer_.is_lost() && !was_lost) {
    app::log_warn(
        "lost: scans do not fit the map where the vehicle should be; looks for it in the local "
        "map");
  } else if (was_lost && !localizer_.is_lost()) {
    app::log_info("found itself again in the local map");
  }
  if (localizer_.is_lost())
    context_.status().set_trouble("lost", "looks for itself in the local map");
  else context_.status().clear_trouble("lost");
}

void LocalizationService::tell_of_lateness(std::uint64_t retimed_before) const {
  if (localizer_.counters().odometry.retimed == retimed_before) return;
  const double late_ms = 1e3 * localizer_.stamp_offset_s();
  app::log_warn("odometry is stamped {:.0f} ms {} against the scans: read so from now on",
                std::abs(late_ms), late_ms > 0.0 ? "late" : "early");
}

void LocalizationService::tell_of_factors(std::uint64_t recalibrated_before) const {
  if (localizer_.counters().odometry.recalibrations == recalibrated_before) return;
  const sensing::WheelFactors factors = localizer_.odometry_conclusions().total;
  app::log_warn(
      "odometry is wrong: its ways count {:.2f} times, its turns {:.2f} times from now on",
      factors.way, factors.turn);
}

void LocalizationService::tell_of_floor(const std::string& scanner_id) const {
  const std::optional<sensing::FloorInView>& floor = localizer_.floor_found_now();
  if (!floor) return;
  app::log_warn(
      "scanner {} looks down: beams meet the floor {:.1f} m away: echoes there and beyond are left "
      "out from now on; mount it level",
      scanner_id, floor->distance_m);
}

}  // namespace slammot::localization
