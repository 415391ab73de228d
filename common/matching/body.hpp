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

/// How many of a scan's points, in the order of the beams, tell of the vehicle's motion: the
/// largest body may be moving itself, so that its points count no more than all others together.
std::size_t independent_points(std::span<const MatchPoint> points, double longest_m);

}  // namespace slammot::matching
