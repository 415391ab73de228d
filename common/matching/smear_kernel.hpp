#pragma once

#include <cstdint>
#include <vector>

#include "common/geometry/pose2.hpp"

namespace slammot::matching {

/// Gaussian of a target point on a grid of bytes, tabulated for a few positions of the point within
/// its cell.
class SmearKernel {
 public:
  static constexpr double kFull = 255.0;  ///< Value of a cell with a point of weight 1 at its
                                          ///< centre.

  SmearKernel(double cell_m, double sigma_m);

  /// Cells that the kernel reaches on each side of the point's own.
  std::int32_t half() const { return half_; }

  /// Square of side 2 * half() + 1, row-major. fraction: position of the point within its cell, in
  /// cells from its lower left corner.
  const std::uint8_t* around(const geometry::Vector2& fraction) const;

 private:
  void append(std::int32_t phase_x, std::int32_t phase_y, double sigmas_per_cell);

  std::int32_t half_;
  std::vector<std::uint8_t> values_;
};

}  // namespace slammot::matching
