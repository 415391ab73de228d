#include "services/tracking/axis_view.hpp"

#include <algorithm>
#include <cmath>

#include "common/geometry/squared.hpp"
#include "services/tracking/size_evidence.hpp"

namespace slammot::tracking {
namespace {

using Eigen::Vector2d;

using geometry::squared;

/// Part of the corner depth that beams grazing the side at an angle of this sine do not meet. A cut
/// at 45 degrees is hidden up to that angle; of a quarter circle r (1 - sine) is, with r = 1.7
/// depths.
double missed_share(double sine) { return std::min(1.15, 2.0 * (1.0 - sine)); }

/// Mean distance that a side continues beyond its outermost echo without answering.
double unanswered_m(const AxisView& view, const EndView& end, Edge edge) {
  constexpr double kMostM = 1.3;  // one sigma of a uniform distribution over a car's length
  return edge == Edge::kNoEcho ? std::min(view.mean_gap * end.spacing_m, kMostM * view.scale) : 0.0;
}

}  // namespace

EndView end_view(const Observation& observation, const Vector2d& place_m, const Vector2d& axis) {
  constexpr double kLeastIncidence = 0.05;
  const Vector2d sight_m = place_m - observation.laser_m;
  const double range_m = std::max(sight_m.norm(), 1e-3);
  const double sine =
      std::min(1.0, std::abs(axis.x() * sight_m.y() - axis.y() * sight_m.x()) / range_m);
  return {range_m * observation.beam_step_rad / std::max(sine, kLeastIncidence),
          missed_share(sine)};
}

AxisView mirrored(const AxisView& view) {
  return {-view.laser_at_m,  view.face_variance_m2, view.high,  view.low,       view.mean_gap,
          view.least_side_m, view.clear_spacing_m,  view.scale, view.is_length, view.corner};
}

bool is_side(const Projection& projection, const AxisView& view) {
  return projection.face_count >= 3 && projection.face_across_m > view.least_side_m;
}

double flat_beyond_m(const AxisView& view, const EndView& end, Edge edge) {
  return 0.5 * end.spacing_m + unanswered_m(view, end, edge);
}

double flat_end_variance_m2(const AxisView& view, const EndView& end, Edge edge) {
  return view.face_variance_m2 + end.spacing_m * end.spacing_m / 12.0 +
         squared(unanswered_m(view, end, edge));
}

double beyond_m(const AxisView& view, const EndView& end, Edge edge) {
  return flat_beyond_m(view, end, edge) + missed_of(view.corner, end.missed_share).value_m;
}

double end_variance_m2(const AxisView& view, const EndView& end, Edge edge) {
  return flat_end_variance_m2(view, end, edge) +
         missed_of(view.corner, end.missed_share).variance_m2;
}

}  // namespace slammot::tracking
