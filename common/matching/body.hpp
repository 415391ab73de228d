#pragma once

#include <cstddef>
#include <span>

#include "common/geometry/pose2.hpp"
#include "common/matching/match_point.hpp"

namespace slammot::matching {

/// Whether the point next in the order of the beams may be of the same body as the run of points
/// from first to last: without a gap, and no farther from the first than longest_m. Points in the
/// base [m].
bool continues_body(const geometry::Vector2& first_m, const geometry::Vector2& last_m,
                    const geometry::Vector2& next_m, double longest_m);

/// End of the body that begins with a point: of the run of points, in the order of the beams, that
/// continue it. Points have in_base_m [m].
template <typename Points>
std::size_t end_of_body(const Points& points, std::size_t first, double longest_m) {
  std::size_t end = first + 1;
  while (end < points.size() && continues_body(points[first].in_base_m, points[end - 1].in_base_m,
                                               points[end].in_base_m, longest_m))
    ++end;
  return end;
}

/// How many of a scan's points, in the order of the beams, tell of the vehicle's motion: the
/// largest body may be moving itself, so that its points count no more than all others together.
std::size_t independent_points(std::span<const MatchPoint> points, double longest_m);

}  // namespace slammot::matching
