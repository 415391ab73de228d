#pragma once

#include <cstdint>

#include <Eigen/Core>

#include "services/tracking/associations.hpp"
#include "services/tracking/observation.hpp"
#include "services/tracking/scan_context.hpp"
#include "services/tracking/track.hpp"

namespace slammot::tracking {

/// Time to which the echoes of an object are moved, and its velocity during the sweep.
struct SweptMotion {
  double time_offset_s = 0.0;  ///< After the scan's stamp.
  Eigen::Vector2d velocity_mps = Eigen::Vector2d::Zero();
};

SweptMotion swept_motion(const Track& track);

/// The beams of a share as an observation, with what lies beside them. Fills the points of the
/// share, to which the observation refers. share.beams: at least one.
Observation observe(TrackShare& share, const SweptMotion& motion, const ResponseRate& responses,
                    const ScanContext& context);

/// Predicts the track to the time when the beam that points at it is fired, in a scan that begins
/// time_s after the one before. Does not go back before the beam of another scanner that observed
/// it last.
void predict_to_beam(Track& track, double time_s, const PolarView& view,
                     const TrackingConfig& config);

/// Nanoseconds, rounded.
std::int64_t nanoseconds(double time_s);

}  // namespace slammot::tracking
