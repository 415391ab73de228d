#pragma once

#include <optional>

#include <Eigen/Core>

#include "services/tracking/axis_view.hpp"
#include "services/tracking/observation.hpp"

namespace slammot::tracking {

/// The side of a box that faces the laser, along one axis.
struct NearSide {
  double at_m = 0.0;     ///< Coordinate.
  double inwards = 1.0;  ///< Sign of the direction into the box.
};

/// None where the laser is beside the box, or too little of the side is visible.
std::optional<NearSide> near_side(const Size& size, const Projection& projection,
                                  const AxisView& view);

/// The two visible sides of a box and how they were seen.
struct CornerView {
  Eigen::Vector2d along;
  Eigen::Vector2d across;
  AxisView u_view;
  AxisView v_view;
  NearSide u;
  NearSide v;
};

/// Depth of the corner between two visible sides, from one observation. None where its echoes are
/// too far apart.
std::optional<Size> seen_corner(const Observation& observation, const Eigen::Vector2d& centre_m,
                                const CornerView& seen);

/// Fuses one more measurement of the depth; the variance has a floor since errors of neighbouring
/// scans are correlated.
Size with_corner(const Size& before, const Size& seen, double scale);

}  // namespace slammot::tracking
