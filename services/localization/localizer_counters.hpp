#pragma once

#include <cstdint>
#include <map>
#include <string>

namespace slammot::localization {

struct Step;
struct ScanMatch;
struct IntegrationCounts;

/// What happened so far; all grow only.
struct LocalizerCounters {
  std::uint64_t scans = 0;
  std::uint64_t duplicate_scans = 0;     ///< Same scanner and stamp as one before: dropped.
  std::uint64_t out_of_order_scans = 0;  ///< Older than one before: dropped.
  std::uint64_t far_ahead_scans = 0;     ///< Stamped far ahead of those before, and no second one
                                         ///< agreed: dropped.
  std::uint64_t blank_scans = 0;         ///< Nothing was measured: pose predicted.
  std::uint64_t frozen_scans = 0;        ///< Readings of the scan before, while odometry moves.
  std::uint64_t too_few_echoes = 0;      ///< Dead reckoning instead of a match.
  std::uint64_t lost_matches = 0;        ///< Too few points matched: dead reckoning.
  std::uint64_t searches = 0;            ///< Correlative searches.
  std::uint64_t sampled_matches = 0;     ///< Along some direction the scan said too little: SCRIM.
  std::uint64_t found_again = 0;  ///< Searches after a lost match that found the pose in the local
                                  ///< map.
  std::uint64_t astray = 0;       ///< Maps begun because it was not found there.
  std::uint64_t withheld_scans = 0;  ///< Not put into the map: it was not sure enough where they
                                     ///< were.
  std::uint64_t odometry_jumps = 0;  ///< Steps taken at constant velocity instead.
  std::uint64_t without_odometry = 0;
  std::uint64_t rough_odometry = 0;  ///< Steps whose odometry was off by several of its sigmas,
  std::uint64_t disbelieved_odometry = 0;   ///< and such as it told nothing of.
  std::uint64_t recalibrations = 0;         ///< Way and turn factors of odometry set anew.
  std::uint64_t retimed_odometry = 0;       ///< Stamps of odometry found late or early.
  std::uint64_t gaps = 0;                   ///< Steps longer than longest_step_s.
  std::uint64_t fallback_integrations = 0;  ///< Labels came too late or not at all.
  std::uint64_t restored_points = 0;        ///< Given back by tracking.
  std::uint64_t submaps = 0;
};

/// By the names of the members, as reports and statuses show them.
std::map<std::string, std::uint64_t> named(const LocalizerCounters& counters);

/// Adds what a step, a match or an integration did.
void count(const Step& step, LocalizerCounters& counters);
void count(const ScanMatch& match, LocalizerCounters& counters);
void count(const IntegrationCounts& integrated, LocalizerCounters& counters);

}  // namespace slammot::localization
