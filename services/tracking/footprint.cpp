#include "services/tracking/footprint.hpp"

#include <algorithm>
#include <cmath>

namespace slammot::tracking {

using Eigen::Vector2d;

Vector2d offset_from(const Footprint& footprint, const Vector2d& centre_m, double margin_m,
                     const Vector2d& point_m) {
  const double c = std::cos(footprint.heading_rad);
  const double s = std::sin(footprint.heading_rad);
  const Vector2d d = point_m - centre_m;
  const auto beyond = [](double value, double half) {
    return std::copysign(std::max(0.0, std::abs(value) - half), value);
  };
  const double u = beyond(c * d.x() + s * d.y(), 0.5 * footprint.length.value_m + margin_m);
  const double v = beyond(-s * d.x() + c * d.y(), 0.5 * footprint.width.value_m + margin_m);
  return {c * u - s * v, s * u + c * v};
}

bool is_inside(const Footprint& footprint, const Vector2d& centre_m, double margin_m,
               const Vector2d& point_m) {
  const double reach_m =
      std::max(0.0, 0.5 * (footprint.length.value_m + footprint.width.value_m) + 2.0 * margin_m);
  return (point_m - centre_m).squaredNorm() <= reach_m * reach_m &&
         offset_from(footprint, centre_m, margin_m, point_m).isZero();
}

}  // namespace slammot::tracking
