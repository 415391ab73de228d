#include "services/collision_warning/oriented_box.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace slammot::collision_warning {
namespace {

using geometry::Vector2;

Vector2 along(const OrientedBox& box) {
  return {std::cos(box.centre.heading_rad), std::sin(box.centre.heading_rad)};
}

Vector2 left_of(const Vector2& axis) { return {-axis.y(), axis.x()}; }

/// Half the extent of the box along a unit vector.
double reach_along_m(const OrientedBox& box, const Vector2& axis) {
  const Vector2 x_axis = along(box);
  return 0.5 * (box.length_m * std::abs(axis.dot(x_axis)) +
                box.width_m * std::abs(axis.dot(left_of(x_axis))));
}

std::array<Vector2, 4> corners_of(const OrientedBox& box) {
  const double x_m = 0.5 * box.length_m;
  const double y_m = 0.5 * box.width_m;
  return {box.centre * Vector2(x_m, y_m), box.centre * Vector2(-x_m, y_m),
          box.centre * Vector2(-x_m, -y_m), box.centre * Vector2(x_m, -y_m)};
}

double distance_to_point_m(const OrientedBox& box, const Vector2& point) {
  const Vector2 in_box = inverse(box.centre) * point;
  const Vector2 outside{std::max(0.0, std::abs(in_box.x()) - 0.5 * box.length_m),
                        std::max(0.0, std::abs(in_box.y()) - 0.5 * box.width_m)};
  return outside.norm();
}

}  // namespace

/// The distance of two disjoint convex polygons is that of a corner of one of them to the other.
double distance_m(const OrientedBox& a, const OrientedBox& b) {
  if (OverlapTest(a, b).overlaps(Vector2::Zero())) return 0.0;
  double nearest_m = std::numeric_limits<double>::infinity();
  for (const Vector2& corner : corners_of(b))
    nearest_m = std::min(nearest_m, distance_to_point_m(a, corner));
  for (const Vector2& corner : corners_of(a))
    nearest_m = std::min(nearest_m, distance_to_point_m(b, corner));
  return nearest_m;
}

OverlapTest::OverlapTest(const OrientedBox& a, const OrientedBox& b)
    : offset_m_(b.centre.translation_m() - a.centre.translation_m()),
      axes_{along(a), left_of(along(a)), along(b), left_of(along(b))} {
  for (std::size_t i = 0; i < axes_.size(); ++i) {
    reach_m_[i] = reach_along_m(a, axes_[i]) + reach_along_m(b, axes_[i]);
    clearance_m_ = std::max(clearance_m_, std::abs(axes_[i].dot(offset_m_)) - reach_m_[i]);
  }
}

bool OverlapTest::overlaps(const Vector2& shift_m) const {
  const Vector2 between_m = offset_m_ + shift_m;
  for (std::size_t i = 0; i < axes_.size(); ++i) {
    if (std::abs(axes_[i].dot(between_m)) > reach_m_[i]) return false;
  }
  return true;
}

}  // namespace slammot::collision_warning
