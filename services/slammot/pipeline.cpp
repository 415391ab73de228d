#include "services/slammot/pipeline.hpp"

#include <utility>

namespace slammot {

Pipeline::Pipeline(const Profile& profile)
    : detection_(profile.detection), localizer_(profile.localization), tracker_(profile.tracking), loop_closer_(profile.loop_closing) {}

void Pipeline::take(const sensing::Odometry& odometry) { localizer_.add_odometry(odometry); }

void Pipeline::take(const sensing::LaserScan& scan) {
  record_.add_scan(scan.stamp_ns);
  const auto localized = times_.measure("localization", [&] { return localizer_.localize(scan); });
  if (!localized) return;
  const auto segmented = times_.measure("detection", [&] { return detection::detect(*localized, detection_); });
  const auto tracked = times_.measure("tracking", [&] { return tracker_.track(segmented); });
  localizer_.expect(tracked.objects);
  times_.measure("mapping", [&] { localizer_.integrate(tracked.labels); });
  record_.add(*localized);
  record_.add(tracked.objects);
  close_loops();
}

void Pipeline::finish() {
  localizer_.finish();
  close_loops();
  for (const flow::Constraint& constraint : loop_closer_.constraints()) record_.add(constraint);
}

void Pipeline::close_loops() {
  while (auto submap = localizer_.take_finished_submap()) {
    const auto correction = times_.measure("loop_closing", [&] { return loop_closer_.add(*submap); });
    localizer_.correct(correction);
    record_.add(correction);
    record_.add(std::move(*submap));
  }
}

std::map<std::string, std::map<std::string, std::uint64_t>> Pipeline::counters() const {
  const localization::LocalizerCounters& l = localizer_.counters();
  const tracking::TrackerCounters& t = tracker_.counters();
  const loop_closing::LoopClosingCounters& c = loop_closer_.counters();
  return {{"localization",
           {{"scans", l.scans},
            {"duplicate_scans", l.duplicate_scans},
            {"out_of_order_scans", l.out_of_order_scans},
            {"too_few_echoes", l.too_few_echoes},
            {"lost_matches", l.lost_matches},
            {"searches", l.searches},
            {"odometry_jumps", l.odometry_jumps},
            {"without_odometry", l.without_odometry},
            {"gaps", l.gaps},
            {"fallback_integrations", l.fallback_integrations},
            {"restored_points", l.restored_points},
            {"submaps", l.submaps}}},
          {"tracking",
           {{"scans", t.scans},
            {"late_scans", t.late_scans},
            {"tracks_begun", t.tracks_begun},
            {"tracks_confirmed", t.tracks_confirmed},
            {"tracks_merged", t.tracks_merged},
            {"tracks_rejected", t.tracks_rejected},
            {"points_restored", t.points_restored}}},
          {"loop_closing",
           {{"submaps", c.submaps},
            {"repeated_submaps", c.repeated_submaps},
            {"searches", c.searches},
            {"hypotheses", c.hypotheses},
            {"ambiguous", c.ambiguous},
            {"inconsistent", c.inconsistent},
            {"closures", c.closures},
            {"optimisations", c.optimisations}}}};
}

}  // namespace slammot
