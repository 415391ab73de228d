#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>

#include <Eigen/Core>

#include "services/tracking/polar_view.hpp"
#include "services/tracking/scan_history.hpp"
#include "services/tracking/tracking_config.hpp"

namespace slammot::tracking {

/// Displacement along its normal of a straight side as wide as a vehicle, since an earlier scan.
struct FaceShift {
  std::span<const std::uint16_t> beams;               ///< Of the current scan, on the side.
  Eigen::Vector2d shift_m = Eigen::Vector2d::Zero();  ///< In odom, from the earlier place.
};

/// Displacement of a side of the segment that is as wide as a vehicle's front: since the latest of
/// the earlier scans (newest first) in which the side was elsewhere, if two of them agree and it
/// exceeds their errors. A creeping vehicle is noticed after 0.1 m, before beams pass where it was
/// and before the map shows it. pose_sigma_m: of the pose between the two scans; called for few
/// segments. Sides that were hidden, or of an object known to move, give none. Cost: linear in the
/// beams of the segment.
std::optional<FaceShift> face_shift(std::span<const std::uint16_t> segment_beams,
                                    const PolarView& now,
                                    std::span<const EarlierScan* const> earlier,
                                    const std::function<double()>& pose_sigma_m,
                                    const TrackingConfig& config);

/// The same of a side whose two ends are two segments, its middle being hidden or dark. The beams
/// are those of the first segment.
std::optional<FaceShift> face_shift_with(std::span<const std::uint16_t> other_beams,
                                         std::span<const std::uint16_t> segment_beams,
                                         const PolarView& now,
                                         std::span<const EarlierScan* const> earlier,
                                         const std::function<double()>& pose_sigma_m,
                                         const TrackingConfig& config);

}  // namespace slammot::tracking
