#include "services/tracking/box_corner.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "common/geometry/squared.hpp"

namespace slammot::tracking {
namespace {

using Eigen::Vector2d;

using geometry::squared;

double spacing_of(const AxisView& view, const NearSide& side) {
  return side.inwards > 0.0 ? view.low.spacing_m : view.high.spacing_m;
}

}  // namespace

std::optional<NearSide> near_side(const Size& size, const Projection& projection,
                                  const AxisView& view) {
  const double beyond_m = std::abs(view.laser_at_m) - 0.5 * size.value_m;
  if (beyond_m < 0.0 || !is_side(projection, view)) return std::nullopt;
  return NearSide{projection.face_m, view.laser_at_m < 0.0 ? 1.0 : -1.0};
}

std::optional<Size> seen_corner(const Observation& observation, const Vector2d& centre_m,
                                const CornerView& seen) {
  constexpr double kWidestSpacingM = 0.3;
  constexpr double kDeepestM = 0.7;        // deeper: the echo next to the corner is missing
  constexpr double kNextEchoShare = 0.25;  // of the spacing: mean distance of the nearest echo from
                                           // a sharp corner,
  constexpr double kNextEchoSigmaShare = 0.3;  // and its sigma
  constexpr double kNearestSigmas = 1.0;       // bias of the minimum over the few echoes on a cut
  constexpr double kSidesSigmaM = 0.04;
  const auto& [along, across, u_view, v_view, u, v] = seen;
  const double spacing_m = std::min(spacing_of(u_view, u), spacing_of(v_view, v));
  if (spacing_m > kWidestSpacingM * u_view.scale) return std::nullopt;
  double depth_m = std::numeric_limits<double>::max();
  for (const Vector2d& point : observation.points_m)
    depth_m = std::min(depth_m, u.inwards * (along.dot(point - centre_m) - u.at_m) +
                                    v.inwards * (across.dot(point - centre_m) - v.at_m));
  if (depth_m > kDeepestM * u_view.scale) return std::nullopt;
  const double sharp_share = std::clamp(1.0 - depth_m / spacing_m, 0.0, 1.0);  // a cut longer than
                                                                               // the spacing has an
                                                                               // echo
  return Size{
      std::max(0.0, depth_m - kNextEchoShare * sharp_share * spacing_m +
                        kNearestSigmas * (1.0 - sharp_share) * std::sqrt(u_view.face_variance_m2)),
      u_view.face_variance_m2 + squared(kNextEchoSigmaShare * spacing_m) +
          squared(kSidesSigmaM * u_view.scale)};
}

Size with_corner(const Size& before, const Size& seen, double scale) {
  constexpr double kLeastSigmaM = 0.02;
  const double gain = before.variance_m2 / (before.variance_m2 + seen.variance_m2);
  return {before.value_m + gain * (seen.value_m - before.value_m),
          std::max(squared(kLeastSigmaM * scale), (1.0 - gain) * before.variance_m2)};
}

}  // namespace slammot::tracking
