#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>

#include <Eigen/Core>

#include "services/tracking/scan_history.hpp"
#include "services/tracking/polar_view.hpp"
#include "services/tracking/tracking_config.hpp"

namespace slammot::tracking {

/// A straight side as wide as a vehicle, that was elsewhere along its normal when an earlier scan was taken.
struct FaceShift {
  std::span<const std::uint16_t> beams;              ///< That met it, of the current scan.
  Eigen::Vector2d shift_m = Eigen::Vector2d::Zero(); ///< In odom, from where it was.
};

/// Where a segment has a side as wide as a vehicle's front: how far that has come along its normal since the latest of the earlier
/// scans (newest first) in which it was elsewhere, if two of them say so and by more than they may err by. Who creeps off shows so after a tenth of a metre, when beams that
/// must pass where it was, and the map, do not tell yet. pose_sigma_m: of the pose between the two scans; asked for few segments only. Sides that were
/// hidden then, or that of something known to move, tell nothing. Cost: linear in the beams of the segment.
std::optional<FaceShift> face_shift(std::span<const std::uint16_t> segment_beams, const PolarView& now,
                                    std::span<const EarlierScan* const> earlier, const std::function<double()>& pose_sigma_m, const TrackingConfig& config);

/// The same of a side of which two segments are the ends, what lies between them being hidden or dark; the beams are those of the first.
std::optional<FaceShift> face_shift_with(std::span<const std::uint16_t> other_beams, std::span<const std::uint16_t> segment_beams, const PolarView& now,
                                         std::span<const EarlierScan* const> earlier, const std::function<double()>& pose_sigma_m, const TrackingConfig& config);

}  // namespace slammot::tracking
