#pragma once

#include <cstddef>
#include <cstdint>

#include "services/tracking/associations.hpp"
#include "services/tracking/scan_comparison.hpp"
#include "services/tracking/scan_context.hpp"
#include "services/tracking/track.hpp"

namespace slammot::tracking {

/// The scanner of the current scan.
struct CurrentScanner {
  std::size_t index = 0;
  bool is_only_one = true;
};

/// Updates a track by its share of the scan: motion, extent and existence. Writes the track and its
/// share only, so that tracks may be updated side by side.
UpdateOutcome update_track(Track& track, TrackShare& share, const ComparedScan& context,
                           const CurrentScanner& scanner);

}  // namespace slammot::tracking
