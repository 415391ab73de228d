#pragma once

#include <cstddef>
#include <deque>
#include <optional>

#include "common/sensing/scan.hpp"

namespace slammot::sensing {

/// Smooths odometry whose single samples are noisy or rounded: the parabola of least squares
/// through the samples around each (Savitzky and Golay 1964), by their stamps. It does not lag,
/// since it waits for the samples after; a constant acceleration passes it unchanged.
class PoseSmoother {
 public:
  /// reach: samples taken on either side.
  explicit PoseSmoother(std::size_t reach) : reach_(reach) {}

  /// Stamps must grow. Returns the sample `reach` before, smoothed; none at first.
  std::optional<Odometry> add(const Odometry& sample);

  /// The next of those that wait, at the end; none when all were returned.
  std::optional<Odometry> finish();

 private:
  std::optional<Odometry> next(std::size_t after);

  std::size_t reach_;
  std::deque<Odometry> samples_;  ///< Around the next one.
  std::size_t next_ = 0;          ///< Its place among them.
};

}  // namespace slammot::sensing
