#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include <Eigen/Core>

#include "services/tracking/observation.hpp"

namespace slammot::testing {

inline constexpr double kStepRad = 0.5 * M_PI / 180.0;

/// Echoes of a box at heading 0 as a laser at the origin gets them.
inline std::vector<Eigen::Vector2d> echoes_of(const Eigen::Vector2d& centre_m, double length_m,
                                              double width_m) {
  std::vector<Eigen::Vector2d> points;
  for (double angle = -M_PI / 2.0; angle <= M_PI / 2.0; angle += kStepRad) {
    const Eigen::Vector2d way{std::cos(angle), std::sin(angle)};
    double near = 0.0, far = 1e9;
    const double half[2] = {0.5 * length_m, 0.5 * width_m};
    for (int axis = 0; axis < 2; ++axis) {
      const double a = (centre_m[axis] - half[axis]) / way[axis],
                   b = (centre_m[axis] + half[axis]) / way[axis];
      near = std::max(near, std::min(a, b)), far = std::min(far, std::max(a, b));
    }
    if (near < far) points.push_back(near * way);
  }
  return points;
}

inline tracking::Observation observation_of(const std::vector<Eigen::Vector2d>& points) {
  tracking::Observation observation;
  observation.points_m = points;
  observation.beam_step_rad = kStepRad;
  return observation;
}

}  // namespace slammot::testing
