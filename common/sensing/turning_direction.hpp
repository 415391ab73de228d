#pragma once

#include <cmath>

#include "common/geometry/pose2.hpp"

namespace slammot::sensing {

/// Unit vectors at first_rad, first_rad + step_rad, ..., by repeated rotation: avoids two
/// trigonometric calls a beam. After 10^5 steps the error is 10^-10.
class TurningDirection {
 public:
  TurningDirection(double first_rad, double step_rad)
      : x_(std::cos(first_rad)),
        y_(std::sin(first_rad)),
        cosine_(std::cos(step_rad)),
        sine_(std::sin(step_rad)) {}

  geometry::Vector2 now() const { return {x_, y_}; }

  void advance() {
    const double x_before = x_;
    x_ = cosine_ * x_ - sine_ * y_;
    y_ = sine_ * x_before + cosine_ * y_;
  }

 private:
  double x_;  // scalars, because a vector stalls each step: docs/performance.md
  double y_;
  double cosine_;
  double sine_;
};

}  // namespace slammot::sensing
