#include "common/matching/saliency.hpp"

#include <algorithm>

namespace slammot::matching {

double saliency_score(const std::vector<MatchPoint>& points, const SaliencyConfig& config,
                      std::mt19937_64& random) {
  if (points.empty()) return 0.0;
  geometry::Vector2 middle_m = geometry::Vector2::Zero();
  for (const MatchPoint& point : points)
    middle_m += point.in_base_m / static_cast<double>(points.size());
  std::vector<MatchPoint> about_middle = points;
  double farthest_m = 0.0;
  for (MatchPoint& point : about_middle) {
    point.in_base_m -= middle_m;
    farthest_m = std::max(farthest_m, point.in_base_m.norm());
  }
  constexpr double kMargin_m = 5.0;
  grids::SurfelMap itself(
      grids::window_around(geometry::Vector2::Zero(), 2.0 * (farthest_m + kMargin_m),
                           config.surfel_size_m),
      1000.0);
  for (const MatchPoint& point : about_middle) itself.add(point.in_base_m);
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
