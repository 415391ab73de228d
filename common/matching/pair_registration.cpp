#include "common/matching/pair_registration.hpp"

#include <algorithm>
#include <cmath>

#include "common/grids/surfel_map.hpp"

namespace slammot::matching {

std::vector<Eigen::Vector2f> points_of(const std::vector<float>& ranges, const AssumedBeams& beams,
                                       double unit_m, std::size_t most) {
  constexpr float kFarthestM = 30.0F;  // limits the size of the grid
  const auto range_m_of = [unit_m](float range) { return range * static_cast<float>(unit_m); };
  const auto counts = [&](float range) {
    return range_m_of(range) > 0.05F && range_m_of(range) < kFarthestM;
  };
  std::vector<Eigen::Vector2f> points;
  const auto echoes = static_cast<std::size_t>(std::ranges::count_if(ranges, counts));
  const std::size_t stride =
      std::max<std::size_t>(1, std::min(ranges.size() / most, 2 * echoes / most));
  for (std::size_t i = 0; i < ranges.size(); i += stride) {
    if (!counts(ranges[i])) continue;
    const float range_m = range_m_of(ranges[i]);
    const auto angle_rad =
        static_cast<float>(beams.first_beam_rad + static_cast<double>(i) * beams.beam_step_rad);
    points.emplace_back(range_m * std::cos(angle_rad), range_m * std::sin(angle_rad));
  }
  return points;
}

PointToLineResult register_pair(PointToLineMatcher& matcher, const ScanPair& pair,
                                const AssumedBeams& beams, double unit_m,
                                const geometry::UncertainPose2& prior) {
  constexpr std::size_t kAllPoints = 2000;
  constexpr double kCell_m = 0.5;
  constexpr double kReach_m = 64.0;  // of all points
  constexpr double kManyEchoes = 1000.0;
  grids::SurfelMap surfels(grids::window_around(geometry::Vector2::Zero(), kReach_m, kCell_m),
                           kManyEchoes);
  for (const Eigen::Vector2f& point : points_of(pair.first, beams, unit_m, kAllPoints))
    surfels.add(point.cast<double>());
  std::vector<MatchPoint> points;
  for (const Eigen::Vector2f& point : points_of(pair.second, beams, unit_m, kAllPoints))
    points.push_back({point.cast<double>()});
  PointToLineConfig config;
  config.unproven_share = 1.0;
  config.proven_after_m = 0.0;
  config.information_share = 1.0;
  return matcher.match(points, surfels, prior, prior.pose, config);
}

}  // namespace slammot::matching
