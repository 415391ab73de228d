#include "services/localization/localizer_counters.hpp"

#include "services/localization/odometry_prediction.hpp"
#include "services/localization/scan_integration.hpp"
#include "services/localization/scan_match.hpp"

namespace slammot::localization {

std::map<std::string, std::uint64_t> named(const LocalizerCounters& counters) {
  return {{"scans", counters.scans.localized},
          {"duplicate_scans", counters.scans.duplicate},
          {"out_of_order_scans", counters.scans.out_of_order},
          {"far_ahead_scans", counters.scans.far_ahead},
          {"blank_scans", counters.scans.blank},
          {"frozen_scans", counters.scans.frozen},
          {"scans_with_floor", counters.scans.with_floor},
          {"too_few_echoes", counters.matches.too_few_echoes},
          {"lost_matches", counters.matches.lost},
          {"searches", counters.matches.searches},
          {"sampled_matches", counters.matches.sampled},
          {"found_again", counters.matches.found_again},
          {"astray", counters.map.astray},
          {"withheld_scans", counters.map.withheld_scans},
          {"odometry_jumps", counters.odometry.jumps},
          {"without_odometry", counters.odometry.missing},
          {"rough_odometry", counters.odometry.rough},
          {"disbelieved_odometry", counters.odometry.disbelieved},
          {"recalibrations", counters.odometry.recalibrations},
          {"retimed_odometry", counters.odometry.retimed},
          {"gaps", counters.odometry.gaps},
          {"fallback_integrations", counters.map.fallback_integrations},
          {"restored_points", counters.map.restored_points},
          {"submaps", counters.map.submaps}};
}

void count(const Step& step, LocalizerCounters& counters) {
  if (step.wheels.are_doubted) ++counters.odometry.jumps;
  else if (!step.is_by_wheels()) ++counters.odometry.missing;
}

void count(const ScanMatch& match, LocalizerCounters& counters) {
  if (match.was_searched) ++counters.matches.searches;
  if (match.was_sampled) ++counters.matches.sampled;
  if (match.is_lost) ++counters.matches.lost;
  else if (!match.is_believed) ++counters.matches.too_few_echoes;
}

void count(const IntegrationCounts& integrated, LocalizerCounters& counters) {
  counters.map.withheld_scans += integrated.withheld_scans;
  counters.map.fallback_integrations += integrated.fallback_integrations;
  counters.map.restored_points += integrated.restored_points;
}

}  // namespace slammot::localization
