#pragma once

#include <algorithm>

#include "common/geometry/pose2.hpp"

namespace slammot::geometry {

/// Point of the line segment from `from_m` to `to_m` that is nearest to `point_m`.
inline Vector2 nearest_on_segment(const Vector2& from_m, const Vector2& to_m,
                                  const Vector2& point_m) {
  const Vector2 along_m = to_m - from_m;
  const double length_m2 = along_m.squaredNorm();
  const double fraction =
      length_m2 > 0.0 ? std::clamp((point_m - from_m).dot(along_m) / length_m2, 0.0, 1.0) : 0.0;
  return from_m + fraction * along_m;
}

}  // namespace slammot::geometry
