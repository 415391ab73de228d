#pragma once

#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include "common/geometry/pose2.hpp"

namespace slammot::detection {

/// Unit vectors along the beams of a scan, each computed when it is first asked for: few are, and those again and again.
class BeamDirections {
 public:
  BeamDirections(double first_beam_rad, double beam_step_rad, std::size_t beams)
      : first_beam_rad_(first_beam_rad),
        beam_step_rad_(beam_step_rad),
        directions_(beams, geometry::Vector2::Constant(std::numeric_limits<double>::quiet_NaN())) {}

  const geometry::Vector2& operator[](std::size_t beam) const {
    geometry::Vector2& direction = directions_[beam];
    if (std::isnan(direction.x())) {
      const double angle_rad = first_beam_rad_ + static_cast<double>(beam) * beam_step_rad_;
      direction = {std::cos(angle_rad), std::sin(angle_rad)};
    }
    return direction;
  }

 private:
  double first_beam_rad_;
  double beam_step_rad_;
  mutable std::vector<geometry::Vector2> directions_;  ///< Not a number before it is asked for.
};

}  // namespace slammot::detection
