#include "common/matching/saliency.hpp"

#include <algorithm>

namespace slammot::matching {
namespace {

/// most: 0 for all.
std::vector<MatchPoint> evenly(const std::vector<MatchPoint>& points, std::size_t most) {
  const std::size_t count = most == 0 ? points.size() : std::min(most, points.size());
  std::vector<MatchPoint> some;
  some.reserve(count);
  for (std::size_t i = 0; i < count; ++i) some.push_back(points[i * points.size() / count]);
  return some;
}

}  // namespace

double saliency_score(const std::vector<MatchPoint>& points, const SaliencyConfig& config,
                      std::mt19937_64& random) {
  return saliency_score(points, points, config, random);
}

double saliency_score(const std::vector<MatchPoint>& points,
                      const std::vector<MatchPoint>& seen_again, const SaliencyConfig& config,
                      std::mt19937_64& random) {
  if (points.empty() || seen_again.empty()) return 0.0;
  geometry::Vector2 middle_m = geometry::Vector2::Zero();
  for (const MatchPoint& point : points)
    middle_m += point.in_base_m / static_cast<double>(points.size());
  double farthest_m = 0.0;
  for (const MatchPoint& point : points)
    farthest_m = std::max(farthest_m, (point.in_base_m - middle_m).norm());
  constexpr double kMargin_m = 5.0;
  grids::SurfelMap itself(
      grids::window_around(geometry::Vector2::Zero(), 2.0 * (farthest_m + kMargin_m),
                           config.surfel_size_m),
      1000.0);
  for (const MatchPoint& point : points) itself.add(point.in_base_m - middle_m);
  std::vector<MatchPoint> about_middle = evenly(seen_again, config.most_points);
  for (MatchPoint& point : about_middle) point.in_base_m -= middle_m;
  const double position_m2 = config.position_sigma_m * config.position_sigma_m;
  const geometry::UncertainPose2 displaced{
      {},
      Eigen::Vector3d(position_m2, position_m2, config.heading_sigma_rad * config.heading_sigma_rad)
          .asDiagonal()};
  return 1.0 / Scrim()
                   .match(about_middle, itself, displaced, config.scrim, config.match, random)
                   .map_from_base.covariance.trace();
}

}  // namespace slammot::matching
