#pragma once

#include <vector>

#include "services/tracking/associations.hpp"
#include "services/tracking/scan_comparison.hpp"
#include "services/tracking/scan_context.hpp"
#include "services/tracking/track.hpp"

namespace slammot::tracking {

/// Assigns segments left over by the assignment that lie inside a box, or are another leg of a
/// pedestrian.
void assign_parts(const std::vector<Track>& tracks, const ComparedScan& context,
                  Associations& associations);

/// Gives confirmed tracks without echoes the echoes inside their extent, of segments that are
/// unassigned or nearer to them than to their owner: several objects may be one segment.
void divide_shared_segments(const std::vector<Track>& tracks, const ComparedScan& context,
                            Associations& associations);

}  // namespace slammot::tracking
