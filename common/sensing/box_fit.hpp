#pragma once

#include <span>

#include <Eigen/Core>

namespace slammot::sensing {

/// Oriented rectangle around points.
struct OrientedBox {
  Eigen::Vector2d centre_m = Eigen::Vector2d::Zero();
  double heading_rad = 0.0;  ///< Of the longer side, in (-pi/2, pi/2].
  double length_m = 0.0;     ///< Of the longer side.
  double width_m = 0.0;
};

/// Sides of a box, for many distance queries.
class BoxSides {
 public:
  explicit BoxSides(const OrientedBox& box);
  /// Distance of a point to the nearest side, from inside or outside.
  double distance_m(const Eigen::Vector2d& point_m) const;

 private:
  Eigen::Vector2d centre_m_;
  Eigen::Vector2d along_;
  Eigen::Vector2d half_size_m_;
};

/// Tightest rectangle of the given heading around the points; at least one point.
OrientedBox box_at_heading(std::span<const Eigen::Vector2d> points_m, double heading_rad);

/// Rectangle whose sides are closest to the points: fits the visible L or I of a vehicle. Two-stage
/// search over the heading with the closeness criterion of Zhang, Xu, Dong, Dolan (IV 2017),
/// Algorithm 4. Needs at least one point. range_noise_m: one sigma, the lower limit of a point's
/// distance to a side.
OrientedBox fit_box(std::span<const Eigen::Vector2d> points_m, double range_noise_m);

}  // namespace slammot::sensing
