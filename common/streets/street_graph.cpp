#include "common/streets/street_graph.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace slammot::streets {

using geometry::Vector2;

double Segment::direction_rad() const {
  const Vector2 along_m = to_m - from_m;
  return std::atan2(along_m.y(), along_m.x());
}

Vector2 Segment::nearest_to(const Vector2& point_m) const {
  const Vector2 along_m = to_m - from_m;
  const double share = along_m.dot(point_m - from_m) / along_m.squaredNorm();
  return from_m + std::clamp(share, 0.0, 1.0) * along_m;
}

std::vector<Segment> StreetGraph::segments() const {
  constexpr double kLeast_m = 1e-3;
  std::vector<Segment> segments;
  for (const Street& street : streets) {
    for (std::size_t i = 1; i < street.line_m.size(); ++i) {
      const Segment segment{street.line_m[i - 1], street.line_m[i]};
      if (segment.length_m() > kLeast_m) segments.push_back(segment);
    }
  }
  return segments;
}

double StreetGraph::length_m() const {
  double sum_m = 0.0;
  for (const Segment& segment : segments()) sum_m += segment.length_m();
  return sum_m;
}

double StreetGraph::distance_m(const Vector2& point_m) const {
  double least_m = std::numeric_limits<double>::infinity();
  for (const Segment& segment : segments())
    least_m = std::min(least_m, (segment.nearest_to(point_m) - point_m).norm());
  return least_m;
}

}  // namespace slammot::streets
