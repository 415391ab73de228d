#pragma once

#include <vector>

#include "common/geometry/pose2.hpp"

namespace slammot::simulation {

/// Smooth way through the plane by arc length, from points at most a few decimetres apart in bends.
class Path {
 public:
  Path() = default;
  /// At least two points, no two neighbours equal.
  explicit Path(const std::vector<geometry::Vector2>& points_in_world);

  double length_m() const { return length_m_; }
  /// Position and direction after arc_m from the start; straight on before the start and beyond the
  /// end.
  geometry::Pose2 pose_at(double arc_m) const;
  const std::vector<geometry::Vector2>& nodes_in_world() const { return nodes_; }

 private:
  double length_m_ = 0.0;
  double spacing_m_ = 1.0;
  std::vector<geometry::Vector2> nodes_;  ///< Equally spaced.
  std::vector<double> headings_rad_;      ///< Of the tangent at each node.
};

/// Points of a cubic Bezier curve (ends included), about spacing_m apart.
std::vector<geometry::Vector2> bezier(const geometry::Vector2& from,
                                      const geometry::Vector2& control_from,
                                      const geometry::Vector2& control_to,
                                      const geometry::Vector2& to, double spacing_m);

/// Straight line's points, ends included, at most spacing_m apart.
std::vector<geometry::Vector2> line(const geometry::Vector2& from, const geometry::Vector2& to,
                                    double spacing_m);

/// Points from corner to corner, straight but for the last bend_m before and the first behind each
/// corner.
std::vector<geometry::Vector2> rounded_way(const std::vector<geometry::Vector2>& corners,
                                           double bend_m);

}  // namespace slammot::simulation
