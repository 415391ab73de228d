#pragma once

#include <Eigen/Core>

#include "services/tracking/observation.hpp"

namespace slammot::tracking {

/// An observation projected on one axis of a box; coordinates relative to a given origin [m].
struct Projection {
  double low_m = 0.0;
  double high_m = 0.0;
  Edge low_edge = Edge::kOpen;  ///< Beside the lowest point, if that is the first or last of the
                                ///< observation.
  Edge high_edge = Edge::kOpen;
  int count = 0;  ///< Of points.
  // The points within face_depth_m of the end towards the laser:
  double face_m = 0.0;         ///< Mean coordinate.
  double face_across_m = 0.0;  ///< Spread across the axis: wide for a side, narrow for the end of a
                               ///< flank.
  int face_count = 0;
};

/// Ends of the observation along the axis; face values are zero.
Projection span_of(const Observation& observation, const Eigen::Vector2d& origin_m,
                   const Eigen::Vector2d& axis);

/// Ends and face of the observation along the axis.
Projection projection_of(const Observation& observation, const Eigen::Vector2d& origin_m,
                         const Eigen::Vector2d& axis, double face_depth_m);

/// The same along the opposite axis.
Projection mirrored(const Projection& projection);

}  // namespace slammot::tracking
