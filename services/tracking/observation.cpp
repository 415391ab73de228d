#include "services/tracking/observation.hpp"

#include <algorithm>
#include <limits>

namespace slammot::tracking {

using Eigen::Vector2d;

double largest_span_m(std::span<const Vector2d> points_m) {
  double largest_m = 0.0;
  constexpr double kRootHalf = 0.70710678;
  for (const Vector2d& axis : {Vector2d(1.0, 0.0), Vector2d(0.0, 1.0),
                               Vector2d(kRootHalf, kRootHalf), Vector2d(kRootHalf, -kRootHalf)}) {
    double low = std::numeric_limits<double>::max();
    double high = std::numeric_limits<double>::lowest();
    for (const Vector2d& point : points_m) {
      const double s = axis.dot(point);
      low = std::min(low, s), high = std::max(high, s);
    }
    largest_m = std::max(largest_m, high - low);
  }
  return largest_m;
}

double mean_gap(const Observation& observation) {
  return observation.unanswered_share / (1.0 - observation.unanswered_share);
}

}  // namespace slammot::tracking
