#include "services/slammot/pipeline.hpp"

namespace slammot {

Pipeline::Pipeline(const Profile& profile) : localizer_(profile.localization) {}

void Pipeline::take(const sensing::Odometry& odometry) { localizer_.add_odometry(odometry); }

void Pipeline::take(const sensing::LaserScan& scan) {
  record_.add_scan(scan.stamp_ns);
  const auto localized = times_.measure("localization", [&] { return localizer_.localize(scan); });
  if (!localized) return;
  record_.add(*localized);
  close_loops();
}

void Pipeline::finish() {
  localizer_.finish();
  close_loops();
}

void Pipeline::close_loops() {
  while (auto submap = localizer_.take_finished_submap()) record_.add(std::move(*submap));
}

std::map<std::string, std::map<std::string, std::uint64_t>> Pipeline::counters() const {
  const localization::LocalizerCounters& c = localizer_.counters();
  return {{"localization",
           {{"scans", c.scans},
            {"duplicate_scans", c.duplicate_scans},
            {"out_of_order_scans", c.out_of_order_scans},
            {"too_few_echoes", c.too_few_echoes},
            {"lost_matches", c.lost_matches},
            {"searches", c.searches},
            {"odometry_jumps", c.odometry_jumps},
            {"without_odometry", c.without_odometry},
            {"gaps", c.gaps},
            {"fallback_integrations", c.fallback_integrations},
            {"restored_points", c.restored_points},
            {"submaps", c.submaps}}}};
}

}  // namespace slammot
