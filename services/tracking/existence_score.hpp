#pragma once

#include <cstddef>

#include "common/flow/segmented_scan.hpp"
#include "services/tracking/scan_view.hpp"
#include "services/tracking/track.hpp"
#include "services/tracking/tracking_config.hpp"

namespace slammot::tracking {

/// What one scan with echoes says of a track.
struct Hit {
  flow::PointLabel label = flow::PointLabel::kUnknown;  ///< Of most of its segments.
  MotionEvidence motion;
  double time_s = 0.0;  ///< Since the scan before.
};

/// Adds a scan with echoes to the score; Wang 2004, Eqs. (5.1)-(5.5). Moving echoes count for the
/// track, echoes on mapped structure, of an implausible extent or off the extent against it.
void score_hit(Track& track, const Hit& hit, const TrackingConfig& config);

/// Adds a scan without echoes to the score: beams that pass through the predicted extent count
/// against the track, occlusion hardly does.
void score_miss(Track& track, const Visibility& visibility, double time_s,
                const TrackingConfig& config);

/// Adds what a scan says of a track that had no echo in the scans before either, and may be hidden:
/// the likelihood that no beam ends on it, over its predicted position.
void score_unseen(Track& track, double time_s);

/// Lowers the score of a box through whose interior more beams pass than are echoed. Does not apply
/// where the map contradicts the echoes: there the object exists and its box is too large.
void score_passed(Track& track, const Visibility& interior, std::size_t echoes);

/// The part of a footprint that the object fills even if size and position are wrong by one sigma,
/// the position either way.
Footprint interior_of(const Track& track);

}  // namespace slammot::tracking
