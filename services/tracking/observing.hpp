#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "services/tracking/observation.hpp"
#include "services/tracking/scan_view.hpp"
#include "services/tracking/track.hpp"

namespace slammot::tracking {

/// Time to which the echoes of an object are moved, and its velocity during the sweep.
struct SweptMotion {
  double time_offset_s = 0.0;   ///< After the scan's stamp.
  Eigen::Vector2d velocity_mps = Eigen::Vector2d::Zero();
};

SweptMotion swept_motion(const Track& track);

/// The echoes of these beams as an observation, with what lies beside them. points_m: filled, and referred to by the observation.
/// size_scale: of all lengths, relative to real road users.
Observation observe(const std::vector<std::uint16_t>& beams, const SweptMotion& motion, const ResponseRate& responses, const ScanView& view,
                    double size_scale, std::vector<Eigen::Vector2d>& points_m);

/// Predicts the track to the time when the beam that points at it is fired, in a scan that begins time_s after the one before. Does not
/// go back before the beam of another scanner that observed it last.
void predict_to_beam(Track& track, double time_s, const PolarView& view, const TrackingConfig& config);

/// Nanoseconds, rounded.
std::int64_t nanoseconds(double time_s);

}  // namespace slammot::tracking
