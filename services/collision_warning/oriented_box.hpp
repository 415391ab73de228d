#pragma once

#include <array>

#include "common/geometry/pose2.hpp"

namespace slammot::collision_warning {

/// A rectangle. The pose is of its centre in a common frame, x along its length.
struct OrientedBox {
  geometry::Pose2 centre;
  double length_m = 0.0;
  double width_m = 0.0;
};

/// Shortest distance of two boxes [m]; 0 if they overlap.
double distance_m(const OrientedBox& a, const OrientedBox& b);

/// Separating axes of two boxes (Gottschalk, Lin and Manocha 1996), prepared for many displacements
/// of the second box.
class OverlapTest {
 public:
  OverlapTest(const OrientedBox& a, const OrientedBox& b);

  /// True if box b, moved by `shift_m`, overlaps box a.
  bool overlaps(const geometry::Vector2& shift_m) const;

  /// No displacement shorter than this makes the boxes overlap [m]; 0 if they overlap already.
  double clearance_m() const { return clearance_m_; }

 private:
  geometry::Vector2 offset_m_;
  std::array<geometry::Vector2, 4> axes_;
  std::array<double, 4> reach_m_{};  ///< Sum of both half extents along each axis.
  double clearance_m_ = 0.0;
};

}  // namespace slammot::collision_warning
