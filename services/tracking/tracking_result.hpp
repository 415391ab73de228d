#pragma once

#include <cstdint>
#include <map>
#include <string>

#include "common/stages/tracking_stage.hpp"

namespace slammot::tracking {

using stages::TrackingResult;

/// Totals since the start.
struct TrackerCounters {
  std::uint64_t scans = 0;
  std::uint64_t late_scans = 0;  ///< Older than one before: labelled as detection did, not tracked.
  std::uint64_t tracks_begun = 0;
  std::uint64_t tracks_confirmed = 0;
  std::uint64_t tracks_merged = 0;
  std::uint64_t tracks_found_again = 0;  ///< Continued under another track after an occlusion.
  std::uint64_t tracks_rejected = 0;  ///< Never confirmed; their points were given back to the map.
  std::uint64_t points_restored = 0;
};

/// By the names of the members, as reports and statuses show them.
inline std::map<std::string, std::uint64_t> named(const TrackerCounters& counters) {
  return {{"scans", counters.scans},
          {"late_scans", counters.late_scans},
          {"tracks_begun", counters.tracks_begun},
          {"tracks_confirmed", counters.tracks_confirmed},
          {"tracks_merged", counters.tracks_merged},
          {"tracks_found_again", counters.tracks_found_again},
          {"tracks_rejected", counters.tracks_rejected},
          {"points_restored", counters.points_restored}};
}

}  // namespace slammot::tracking
