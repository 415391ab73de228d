#pragma once

namespace slammot::matching {

/// Weight of Geman and McClure for a residual in the unit of the scale (> 0): 1 at zero, a quarter
/// at the scale.
inline double robust_weight(double residual, double scale) {
  const double ratio = residual / scale;
  const double root = 1.0 / (1.0 + ratio * ratio);
  return root * root;
}

}  // namespace slammot::matching
