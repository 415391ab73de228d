#pragma once

#include <cstdint>
#include <vector>

#include "services/tracking/scan_comparison.hpp"
#include "services/tracking/scan_context.hpp"
#include "services/tracking/track.hpp"

namespace slammot::tracking {

/// What the echoes of a track in this scan say of its motion. A confirmed track is compared with
/// the usual earlier scan, a tentative one with that in which it has moved most.
MotionEvidence motion_evidence(const Track& track, const std::vector<std::uint16_t>& beams,
                               const ComparedScan& context);

/// The evidence of a tentative track with the echoes of this scan.
TentativeEvidence with_echoes(TentativeEvidence tentative, const std::vector<std::uint16_t>& beams,
                              const ComparedScan& context);

}  // namespace slammot::tracking
