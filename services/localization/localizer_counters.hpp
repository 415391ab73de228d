#pragma once

#include <cstdint>
#include <map>
#include <string>

namespace slammot::localization {

struct Step;
struct ScanMatch;
struct IntegrationCounts;

/// What became of scans as they came.
struct ScanCounters {
  std::uint64_t localized = 0;
  std::uint64_t duplicate = 0;     ///< Same scanner and stamp as one before: dropped.
  std::uint64_t out_of_order = 0;  ///< Older than one before: dropped.
  std::uint64_t far_ahead = 0;     ///< Stamped far ahead of those before, and no second one agreed:
                                   ///< dropped.
  std::uint64_t blank = 0;         ///< Nothing was measured: pose predicted.
  std::uint64_t frozen = 0;        ///< Readings of the scan before, while odometry moves.
  std::uint64_t with_floor = 0;  ///< Localized without the floor that their scanner looks down at.
};

struct MatchCounters {
  std::uint64_t too_few_echoes = 0;  ///< Dead reckoning instead of a match.
  std::uint64_t lost = 0;            ///< Too few points matched: dead reckoning.
  std::uint64_t searches = 0;        ///< Correlative searches.
  std::uint64_t sampled = 0;         ///< Along some direction the scan said too little: SCRIM.
  std::uint64_t found_again = 0;  ///< Searches after a lost match that found the pose in the local
                                  ///< map.
};

/// Steps between scans.
struct OdometryCounters {
  std::uint64_t jumps = 0;           ///< Taken at constant velocity instead.
  std::uint64_t missing = 0;         ///< Without odometry.
  std::uint64_t rough = 0;           ///< Whose odometry was off by several of its sigmas,
  std::uint64_t disbelieved = 0;     ///< and such as it told nothing of.
  std::uint64_t recalibrations = 0;  ///< Way and turn factors of odometry set anew.
  std::uint64_t retimed = 0;         ///< Stamps of odometry found late or early.
  std::uint64_t gaps = 0;            ///< Longer than longest_step_s.
};

struct MapCounters {
  std::uint64_t submaps = 0;
  std::uint64_t astray = 0;  ///< Submaps begun because the pose was not found in the last one.
  std::uint64_t withheld_scans = 0;  ///< Not put into the map: it was not sure enough where they
                                     ///< were.
  std::uint64_t fallback_integrations = 0;  ///< Labels came too late or not at all.
  std::uint64_t restored_points = 0;        ///< Given back by tracking.
};

/// What happened so far; all grow only.
struct LocalizerCounters {
  ScanCounters scans;
  MatchCounters matches;
  OdometryCounters odometry;
  MapCounters map;
};

/// By the names under which reports and statuses show them.
std::map<std::string, std::uint64_t> named(const LocalizerCounters& counters);

/// Adds what a step, a match or an integration did.
void count(const Step& step, LocalizerCounters& counters);
void count(const ScanMatch& match, LocalizerCounters& counters);
void count(const IntegrationCounts& integrated, LocalizerCounters& counters);

}  // namespace slammot::localization
