#include "common/simulation/path.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace slammot::simulation {

using geometry::Pose2;
using geometry::Vector2;

Path::Path(const std::vector<Vector2>& points_in_world) {
  assert(points_in_world.size() >= 2);
  std::vector<double> arcs_m{0.0};
  for (std::size_t i = 1; i < points_in_world.size(); ++i) {
    arcs_m.push_back(arcs_m.back() + (points_in_world[i] - points_in_world[i - 1]).norm());
  }
  constexpr double kSpacing_m = 0.25;
  const auto steps = static_cast<std::size_t>(std::max(1.0, std::ceil(arcs_m.back() / kSpacing_m)));
  length_m_ = arcs_m.back();
  spacing_m_ = length_m_ / static_cast<double>(steps);
  std::size_t piece = 1;
  for (std::size_t i = 0; i <= steps; ++i) {
    const double arc_m = std::min(length_m_, spacing_m_ * static_cast<double>(i));
    while (piece + 1 < arcs_m.size() && arcs_m[piece] < arc_m) ++piece;
    const double fraction = (arc_m - arcs_m[piece - 1]) / (arcs_m[piece] - arcs_m[piece - 1]);
    nodes_.push_back(points_in_world[piece - 1] +
                     fraction * (points_in_world[piece] - points_in_world[piece - 1]));
  }
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    const Vector2 tangent = nodes_[std::min(i + 1, nodes_.size() - 1)] - nodes_[i == 0 ? 0 : i - 1];
    headings_rad_.push_back(std::atan2(tangent.y(), tangent.x()));
  }
}

Pose2 Path::pose_at(double arc_m) const {
  const double position = arc_m / spacing_m_;
  const auto last_piece = static_cast<double>(nodes_.size() - 2);
  const auto piece = static_cast<std::size_t>(std::clamp(std::floor(position), 0.0, last_piece));
  const double fraction = position - static_cast<double>(piece);
  const Vector2 point = nodes_[piece] + fraction * (nodes_[piece + 1] - nodes_[piece]);
  const double turn_rad = geometry::wrap_angle(headings_rad_[piece + 1] - headings_rad_[piece]);
  const double heading_rad = headings_rad_[piece] + std::clamp(fraction, 0.0, 1.0) * turn_rad;
  return {point.x(), point.y(), geometry::wrap_angle(heading_rad)};
}

std::vector<Vector2> bezier(const Vector2& from, const Vector2& control_from,
                            const Vector2& control_to, const Vector2& to, double spacing_m) {
  const double upper_length_m =
      (control_from - from).norm() + (control_to - control_from).norm() + (to - control_to).norm();
  const int steps = std::max(1, static_cast<int>(std::ceil(upper_length_m / spacing_m)));
  std::vector<Vector2> points;
  for (int i = 0; i <= steps; ++i) {
    const double t = static_cast<double>(i) / steps;
    const double u = 1.0 - t;
    points.push_back(u * u * u * from + 3.0 * u * u * t * control_from +
                     3.0 * u * t * t * control_to + t * t * t * to);
  }
  return points;
}

std::vector<Vector2> line(const Vector2& from, const Vector2& to, double spacing_m) {
  return bezier(from, from + (to - from) / 3.0, from + 2.0 * (to - from) / 3.0, to, spacing_m);
}

std::vector<Vector2> rounded_way(const std::vector<Vector2>& corners, double bend_m) {
  std::vector<Vector2> points{corners.front()};
  const auto extend = [&points](const std::vector<Vector2>& more) {
    points.insert(points.end(), more.begin() + 1, more.end());
  };
  for (std::size_t i = 1; i + 1 < corners.size(); ++i) {
    const Vector2 in = (corners[i] - corners[i - 1]).normalized();
    const Vector2 out = (corners[i + 1] - corners[i]).normalized();
    const Vector2 enter = corners[i] - bend_m * in;
    const Vector2 leave = corners[i] + bend_m * out;
    extend(line(points.back(), enter, 0.2));
    if (in.dot(out) > 0.999) {
      extend(line(enter, leave, 0.2));
    } else {
      extend(bezier(enter, enter + 0.55 * bend_m * in, leave - 0.55 * bend_m * out, leave, 0.02));
    }
  }
  extend(line(points.back(), corners.back(), 0.2));
  return points;
}

}  // namespace slammot::simulation
