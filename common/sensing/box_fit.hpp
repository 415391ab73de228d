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

/// The sides of a box, of which many distances are asked.
class BoxSides {
 public:
  explicit BoxSides(const OrientedBox& box);
  /// How far a point is from the nearest side, from inside or outside.
  double distance_m(const Eigen::Vector2d& point_m) const;

 private:
  Eigen::Vector2d centre_m_;
  Eigen::Vector2d along_;
  Eigen::Vector2d half_size_m_;
};

/// Tightest rectangle of the given heading around the points; at least one point.
OrientedBox box_at_heading(std::span<const Eigen::Vector2d> points_m, double heading_rad);

/// Rectangle whose sides the points lie closest to: the visible L or I of a vehicle. Search over the heading in two
/// stages with the closeness criterion of Zhang, Xu, Dong, Dolan (IV 2017), Algorithm 4. At least one point.
/// range_noise_m: one sigma; a point is not closer to a side than that.
OrientedBox fit_box(std::span<const Eigen::Vector2d> points_m, double range_noise_m);

}  // namespace slammot::sensing
