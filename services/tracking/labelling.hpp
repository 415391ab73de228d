#pragma once

#include <cstddef>
#include <vector>

#include "common/flow/segmented_scan.hpp"
#include "services/tracking/associations.hpp"
#include "services/tracking/scan_comparison.hpp"
#include "services/tracking/scan_context.hpp"
#include "services/tracking/track.hpp"

namespace slammot::tracking {

/// Corrects detection's labels of the beams by the comparison with earlier scans and by the
/// confirmed tracks.
void label_beams(const std::vector<Track>& tracks, const Associations& associations,
                 const ComparedScan& context, std::vector<flow::PointLabel>& labels);

/// The object that each beam met, as the history of scans keeps it.
void find_owners(const std::vector<Track>& tracks, const Associations& associations,
                 const ComparedScan& context, std::vector<Owner>& owners);

/// Keeps the beams of a tentative track: if it is rejected they are given back to the map. Not
/// those of an object known to have come.
void keep_points(Track& track, const std::vector<std::uint16_t>& beams, std::size_t scanner,
                 const ComparedScan& context);

}  // namespace slammot::tracking
