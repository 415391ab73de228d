#pragma once

#include <Eigen/Core>

#include "services/tracking/projection.hpp"
#include "services/tracking/road_users.hpp"

namespace slammot::tracking {

/// How the laser looks at one end of a side.
struct EndView {
  double spacing_m = 0.0;     ///< Between echoes at this end.
  double missed_share = 0.0;  ///< Part of the corner depth that no beam meets.
};

/// One axis of a box as seen from the laser.
struct AxisView {
  double laser_at_m = 0.0;        ///< Coordinate of the laser relative to the predicted centre.
  double face_variance_m2 = 0.0;  ///< Of one echo from a side across the axis.
  EndView low;
  EndView high;
  double mean_gap = 0.0;         ///< Consecutive beams without an echo.
  double least_side_m = 0.4;     ///< Narrower faces are not sides.
  double clear_spacing_m = 0.5;  ///< With wider spacing the end of a side is unknown.
  double scale = 1.0;            ///< Of all sizes, relative to real road users.
  bool is_length = true;         ///< The axis of the length.
  Size corner;                   ///< Depth of the corners.
};

/// View of the end of a side along the axis, at this place.
EndView end_view(const Observation& observation, const Eigen::Vector2d& place_m,
                 const Eigen::Vector2d& axis);

/// The same along the opposite axis.
AxisView mirrored(const AxisView& view);

/// True if the end towards the laser is a side across the axis, not the end of a partly hidden
/// flank.
bool is_side(const Projection& projection, const AxisView& view);

/// Mean distance of the end of a side beyond its outermost echo: half a spacing, or a mean gap.
/// Without the corner's part.
double flat_beyond_m(const AxisView& view, const EndView& end, Edge edge);
/// Its variance.
double flat_end_variance_m2(const AxisView& view, const EndView& end, Edge edge);

/// The same of a box, whose corner hides a part.
double beyond_m(const AxisView& view, const EndView& end, Edge edge);
double end_variance_m2(const AxisView& view, const EndView& end, Edge edge);

}  // namespace slammot::tracking
