#include "common/matching/body.hpp"

#include <algorithm>

namespace slammot::matching {
namespace {

constexpr double kGap_m = 0.3;      ///< Between neighbouring points of two bodies; it grows with
constexpr double kGap_perM = 0.03;  ///< the range by this: three beams of half a degree.

}  // namespace

bool continues_body(const geometry::Vector2& first_m, const geometry::Vector2& last_m,
                    const geometry::Vector2& next_m, double longest_m) {
  return (next_m - last_m).norm() < kGap_m + kGap_perM * next_m.norm() &&
         (next_m - first_m).norm() < longest_m;
}

std::size_t independent_points(std::span<const MatchPoint> points, double longest_m) {
  std::size_t largest = 0;
  for (std::size_t first = 0, end = 0; first < points.size(); first = end) {
    end = end_of_body(points, first, longest_m);
    largest = std::max(largest, end - first);
  }
  return std::min(points.size(), 2 * (points.size() - largest));
}

}  // namespace slammot::matching
