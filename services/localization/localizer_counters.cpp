#include "services/localization/localizer_counters.hpp"

#include "services/localization/odometry_prediction.hpp"
#include "services/localization/scan_integration.hpp"
#include "services/localization/scan_match.hpp"

namespace slammot::localization {

std::map<std::string, std::uint64_t> named(const LocalizerCounters& counters) {
  return {{"scans", counters.scans},
          {"duplicate_scans", counters.duplicate_scans},
          {"out_of_order_scans", counters.out_of_order_scans},
          {"far_ahead_scans", counters.far_ahead_scans},
          {"blank_scans", counters.blank_scans},
          {"frozen_scans", counters.frozen_scans},
          {"too_few_echoes", counters.too_few_echoes},
          {"lost_matches", counters.lost_matches},
          {"searches", counters.searches},
          {"sampled_matches", counters.sampled_matches},
          {"found_again", counters.found_again},
          {"astray", counters.astray},
          {"withheld_scans", counters.withheld_scans},
          {"odometry_jumps", counters.odometry_jumps},
          {"without_odometry", counters.without_odometry},
          {"rough_odometry", counters.rough_odometry},
          {"disbelieved_odometry", counters.disbelieved_odometry},
          {"recalibrations", counters.recalibrations},
          {"retimed_odometry", counters.retimed_odometry},
          {"gaps", counters.gaps},
          {"fallback_integrations", counters.fallback_integrations},
          {"restored_points", counters.restored_points},
          {"submaps", counters.submaps}};
}

void count(const Step& step, LocalizerCounters& counters) {
  if (step.wheels.are_doubted) ++counters.odometry_jumps;
  else if (!step.is_by_wheels()) ++counters.without_odometry;
}

void count(const ScanMatch& match, LocalizerCounters& counters) {
  if (match.was_searched) ++counters.searches;
  if (match.was_sampled) ++counters.sampled_matches;
  if (match.is_lost) ++counters.lost_matches;
  else if (!match.is_believed) ++counters.too_few_echoes;
}

void count(const IntegrationCounts& integrated, LocalizerCounters& counters) {
  counters.withheld_scans += integrated.withheld_scans;
  counters.fallback_integrations += integrated.fallback_integrations;
  counters.restored_points += integrated.restored_points;
}

}  // namespace slammot::localization
