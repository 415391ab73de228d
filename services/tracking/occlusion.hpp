#pragma once

#include "services/tracking/scan_view.hpp"
#include "services/tracking/track.hpp"

namespace slammot::tracking {

/// What a scan can show of a track, by ray casting over its predicted position: means over the
/// position's distribution along its longest axis (three-point Gauss-Hermite quadrature).
struct ExpectedView {
  double in_view = 0.0;  ///< Probability that beams point at it.
  double visible = 0.0;  ///< Share of these beams that nothing ends before they reach the
                         ///< footprint.
  double passed = 0.0;   ///< Share of these beams that end behind the footprint.
};

ExpectedView expected_view(const Track& track, const ScanView& view, const TrackingConfig& config);

/// Updates `track.history.is_hidden` by the scan: hidden while nothing is expected to be seen of
/// it. A track hidden for long whose prediction is too uncertain to be updated by single segments
/// stays so until another track is found to be its object.
void follow_occlusion(Track& track, const ScanView& view, const TrackingConfig& config);

}  // namespace slammot::tracking
