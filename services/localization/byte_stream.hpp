#pragma once

#include <cmath>

#include <Eigen/Core>

#include "common/geometry/pose2.hpp"
#include "common/memory/byte_stream.hpp"

namespace slammot::localization {

using memory::ByteReader;
using memory::checksum;
using memory::put;
using memory::put_all;
using memory::put_bytes;
using memory::put_cells;
using memory::unsealed;

/// Whether a place that was read can be worked with: near enough that cells of any size can be
/// counted.
inline bool is_believable(const geometry::Vector2& place_m) {
  constexpr double kFarthest_m = 1e7;
  return std::abs(place_m.x()) < kFarthest_m && std::abs(place_m.y()) < kFarthest_m;
}

/// The same of a pose.
inline bool is_believable(const geometry::Pose2& pose) {
  return is_believable(pose.translation_m()) && std::isfinite(pose.heading_rad);
}

/// Whether a matrix that was read can be a covariance of a pose, or of a pose and a calibration.
template <int size>
bool is_believable(const Eigen::Matrix<double, size, size>& covariance) {
  constexpr double kLargest = 1e6;
  for (int i = 0; i < size; ++i) {
    if (!(covariance(i, i) >= 0.0 && covariance(i, i) < kLargest)) return false;
    for (int j = 0; j < size; ++j) {
      if (!(covariance(i, j) * covariance(i, j) <= 1.001 * covariance(i, i) * covariance(j, j)))
        return false;
    }
  }
  return true;
}

}  // namespace slammot::localization
