#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "services/tracking/associations.hpp"
#include "services/tracking/road_users.hpp"
#include "services/tracking/scan_comparison.hpp"
#include "services/tracking/scan_context.hpp"
#include "services/tracking/track.hpp"

namespace slammot::tracking {

/// True if an unassigned segment may be a moving object: it contradicts the map and did not stand
/// before, or it arrived or receded where the map does not know or has not yet forgotten what stood
/// there. False inside a confirmed vehicle.
bool may_initiate(std::size_t segment, const std::vector<Track>& tracks,
                  const Associations& associations, const ComparedScan& context);

/// What a new track is initiated from.
struct Initiation {
  flow::TrackId track_id;
  std::size_t segment = 0;
  std::size_t scanner = 0;  ///< Index of the scan's scanner.
  const RoadUsers& road_users;
};

/// Initiates a track from a segment, in the memory of an ended one. Writes the track and its share.
void initiate_from_segment(Track& track, TrackShare& share, const Initiation& initiation,
                           const ComparedScan& context);

}  // namespace slammot::tracking
