#include "common/matching/icp.hpp"

#include <algorithm>
#include <cmath>

#include "common/geometry/displacement.hpp"

namespace slammot::matching {

using geometry::Pose2;
using geometry::Vector2;

Pose2 align_pairs(std::span<const PointPair> pairs) {
  if (pairs.empty()) return {};
  Vector2 a_mean = Vector2::Zero();
  Vector2 b_mean = Vector2::Zero();
  for (const PointPair& pair : pairs) {
    a_mean += pair.in_target_m;
    b_mean += pair.in_source_m;
  }
  a_mean /= static_cast<double>(pairs.size());
  b_mean /= static_cast<double>(pairs.size());
  double along = 0.0;   // S_bxax + S_byay
  double across = 0.0;  // S_bxay - S_byax
  for (const PointPair& pair : pairs) {
    const Vector2 a = pair.in_target_m - a_mean;
    const Vector2 b = pair.in_source_m - b_mean;
    along += b.dot(a);
    across += b.x() * a.y() - b.y() * a.x();
  }
  const double heading_rad = std::atan2(across, along);
  const Vector2 translation_m = a_mean - geometry::rotation(heading_rad) * b_mean;
  return {translation_m.x(), translation_m.y(), heading_rad};
}

IcpResult match_by_icp(const std::vector<MatchPoint>& points, const grids::SurfelMap& surfels,
                       const Pose2& initial_map_from_base, const IcpConfig& config) {
  IcpResult result{.map_from_base = initial_map_from_base};
  std::vector<PointPair> pairs;
  pairs.reserve(points.size());
  for (int step = 0; step < config.coarse_steps + config.fine_steps; ++step) {
    const bool is_coarse = step < config.coarse_steps;
    const double gate_m = is_coarse ? config.coarse_gate_m : config.fine_gate_m;
    const int radius =
        std::max(1, static_cast<int>(std::ceil(gate_m / surfels.window().cell_size_m - 0.5)));
    const geometry::Matrix2 turn = geometry::rotation(result.map_from_base.heading_rad);
    pairs.clear();
    for (const MatchPoint& point : points) {
      const Vector2 at_m = turn * point.in_base_m + result.map_from_base.translation_m();
      const auto surface = surfels.nearest_surface(at_m, radius);
      if (surface && (surface->mean_m - at_m).squaredNorm() <= gate_m * gate_m)
        pairs.push_back({surface->mean_m, point.in_base_m});
    }
    result.matched_points = static_cast<int>(pairs.size());
    if (pairs.empty()) return result;
    const Pose2 next = align_pairs(pairs);
    const Eigen::Vector3d change = geometry::difference(next, result.map_from_base);
    result.map_from_base = next;
    ++result.steps;
    if (geometry::as_seen_10_m_away(change) >= config.converged_m) continue;
    if (!is_coarse) break;
    step = config.coarse_steps - 1;
  }
  return result;
}

}  // namespace slammot::matching
