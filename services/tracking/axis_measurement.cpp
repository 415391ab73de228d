#include "services/tracking/axis_measurement.hpp"

#include <algorithm>
#include <cmath>

#include "common/geometry/squared.hpp"

namespace slammot::tracking {
namespace {

constexpr int kFewestOnFlank = 3;  ///< Echoes on a flank that tell where it ends.

using geometry::squared;

/// True for one or two echoes beside which the next beams pass on both sides: they tell how wide
/// the body can be.
bool is_passed_on_both_sides(const Projection& projection) {
  return projection.count < kFewestOnFlank && projection.low_edge == Edge::kOpen &&
         projection.high_edge == Edge::kOpen;
}

/// The laser lies beyond the low side. The high end is the end of the flank, if the flank is
/// visible.
void add_sizes_from_low_side(SizeEvidence& evidence, const Projection& projection,
                             const AxisView& view, bool is_flank_visible) {
  const double low_m = projection.face_count >= 3 ? projection.face_m : projection.low_m;
  add_part(evidence, projection.high_m - low_m);
  const bool is_low_seen = projection.low_edge == Edge::kOpen || is_side(projection, view);
  const bool is_high_seen = is_flank_visible && projection.high_edge != Edge::kHidden &&
                            view.high.spacing_m < view.clear_spacing_m &&
                            projection.count - projection.face_count >= kFewestOnFlank;
  if (is_low_seen && is_high_seen)  // the flank ends between its last echo and the place of the
                                    // next one
    add_whole(evidence,
              {projection.high_m + flat_beyond_m(view, view.high, projection.high_edge) - low_m,
               flat_end_variance_m2(view, view.high, projection.high_edge), view.high.missed_share},
              view.scale);
}

/// The laser lies beside the box: both ends are ends of the flank.
void add_sizes_from_beside(SizeEvidence& evidence, const Projection& projection,
                           const AxisView& view) {
  add_part(evidence, projection.high_m - projection.low_m);
  const double spacing_m = std::max(view.low.spacing_m, view.high.spacing_m);
  if (projection.low_edge != Edge::kHidden && projection.high_edge != Edge::kHidden &&
      spacing_m < view.clear_spacing_m &&
      (projection.count >= kFewestOnFlank || is_passed_on_both_sides(projection)))
    add_whole(
        evidence,
        {projection.high_m - projection.low_m + flat_beyond_m(view, view.low, projection.low_edge) +
             flat_beyond_m(view, view.high, projection.high_edge),
         flat_end_variance_m2(view, view.low, projection.low_edge) +
             flat_end_variance_m2(view, view.high, projection.high_edge),
         view.low.missed_share + view.high.missed_share},
        view.scale);
}

/// True if so few beams are answered that the outermost echoes are probably not at the ends, and
/// nothing hides an end.
bool may_end_anywhere(const Projection& projection, const AxisView& view) {
  constexpr double kDarkGap = 0.5;
  return view.is_length && view.mean_gap > kDarkGap &&
         std::max(projection.low_edge, projection.high_edge) == Edge::kNoEcho;
}

/// Few echoes from anywhere on the flank: the centre is uniform between its place if the first echo
/// is at one end and its place if the last echo is at the other.
AxisMeasurement centre_from_few(const Size& size, const Projection& projection,
                                const AxisView& view) {
  const double unseen_m = std::max(0.0, size.value_m - (projection.high_m - projection.low_m));
  const double spacing_m = std::max(view.low.spacing_m, view.high.spacing_m);
  return {0.5 * (projection.low_m + projection.high_m),
          view.face_variance_m2 + squared(spacing_m) / 12.0 + squared(unseen_m) / 12.0, 0};
}

AxisMeasurement centre_from_beside(const Size& size, const Projection& projection,
                                   const AxisView& view) {
  if (may_end_anywhere(projection, view)) return centre_from_few(size, projection, view);
  AxisMeasurement axis;
  const double low_m =
      projection.low_m - beyond_m(view, view.low, projection.low_edge) + 0.5 * size.value_m;
  const double high_m =
      projection.high_m + beyond_m(view, view.high, projection.high_edge) - 0.5 * size.value_m;
  const bool is_low_seen = projection.low_edge != Edge::kHidden;
  const bool is_high_seen = projection.high_edge != Edge::kHidden;
  const double low_variance_m2 = end_variance_m2(view, view.low, projection.low_edge);
  const double high_variance_m2 = end_variance_m2(view, view.high, projection.high_edge);
  // Where the two ends disagree, a part was not seen: the difference bounds the error of the
  // centre.
  if (is_low_seen && is_high_seen) {
    axis.anchor = 0;
    axis.centre_m = 0.5 * (low_m + high_m);
    axis.variance_m2 =
        0.25 * (low_variance_m2 + high_variance_m2) + 0.25 * (low_m - high_m) * (low_m - high_m);
  } else if (is_low_seen) {
    axis.centre_m = low_m, axis.variance_m2 = low_variance_m2, axis.anchor = -1;
  } else if (is_high_seen) {
    axis.centre_m = high_m, axis.variance_m2 = high_variance_m2, axis.anchor = 1;
  }
  return axis;
}

AxisMeasurement centre_from_low_side(const Size& size, const Projection& projection,
                                     const AxisView& view, bool is_flank_visible) {
  AxisMeasurement axis;
  if (may_end_anywhere(projection, view) && !is_side(projection, view) && is_flank_visible)
    return centre_from_few(size, projection, view);
  if (projection.low_edge != Edge::kHidden || is_side(projection, view)) {
    const double low_m = projection.face_count >= 3 ? projection.face_m : projection.low_m;
    axis.centre_m = low_m + 0.5 * size.value_m;
    axis.variance_m2 = is_side(projection, view)
                           ? view.face_variance_m2
                           : end_variance_m2(view, view.low, projection.low_edge);
    axis.anchor = -1;
  } else if (is_flank_visible && projection.high_edge == Edge::kOpen) {
    axis.centre_m =
        projection.high_m + beyond_m(view, view.high, projection.high_edge) - 0.5 * size.value_m;
    axis.variance_m2 = end_variance_m2(view, view.high, projection.high_edge);
    axis.anchor = 1;
  }
  return axis;
}

AxisMeasurement mirrored(const AxisMeasurement& axis) {
  return {-axis.centre_m, axis.variance_m2,
          axis.anchor ? std::optional(-*axis.anchor) : std::nullopt};
}

}  // namespace

AxisMeasurement measure_axis(const Size& size, const Projection& projection, const AxisView& view,
                             bool is_flank_visible) {
  if (std::abs(view.laser_at_m) <= 0.5 * size.value_m)
    return centre_from_beside(size, projection, view);
  if (view.laser_at_m < 0.0) return centre_from_low_side(size, projection, view, is_flank_visible);
  return mirrored(
      centre_from_low_side(size, mirrored(projection), mirrored(view), is_flank_visible));
}

void add_sizes(SizeEvidence& evidence, const Size& size, const Projection& projection,
               const AxisView& view, bool is_flank_visible) {
  if (is_passed_on_both_sides(projection) || std::abs(view.laser_at_m) <= 0.5 * size.value_m)
    add_sizes_from_beside(evidence, projection, view);
  else if (view.laser_at_m < 0.0)
    add_sizes_from_low_side(evidence, projection, view, is_flank_visible);
  else add_sizes_from_low_side(evidence, mirrored(projection), mirrored(view), is_flank_visible);
}

double step_variance_m2(std::optional<int> anchor_before, std::optional<int> anchor,
                        const Size& size) {
  return anchor_before && anchor ? squared(0.5 * (*anchor - *anchor_before)) * size.variance_m2
                                 : 0.0;
}

}  // namespace slammot::tracking
