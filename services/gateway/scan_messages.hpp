#pragma once

#include <vector>

#include "common/flow/localized_scan.hpp"
#include "common/flow/segmented_scan.hpp"
#include "common/sensing/scan.hpp"
#include "foxglove.pb.h"

namespace slammot::gateway {

/// The scan as measured, in its laser frame. Ranges without echo are infinite.
foxglove::LaserScan laser_scan_message(const sensing::LaserScan& scan);

/// Bytes of one point of labelled_points_message(): x, y [m] as float32, then red, green, blue,
/// alpha and label as uint8, and three unused bytes.
inline constexpr std::uint32_t kPointStride = 16;

/// Label of points for which no label came.
inline constexpr std::uint8_t kUnlabelled = 255;

/// The echoes of a scan, deskewed, in base, coloured by label (flow::PointLabel). labels: one a
/// beam, or empty if none came.
foxglove::PointCloud labelled_points_message(const flow::LocalizedScan& scan,
                                             const std::vector<flow::PointLabel>& labels);

}  // namespace slammot::gateway
