#include "services/localization/pose_search.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace slammot::localization {

using geometry::UncertainPose2;

bool is_vague(const UncertainPose2& prior, const LocalizerConfig& config) {
  const double position_m2 = std::max(prior.covariance(0, 0), prior.covariance(1, 1));
  return position_m2 > config.search_when_sigma_m * config.search_when_sigma_m ||
         prior.covariance(2, 2) > config.search_when_heading_sigma_rad * config.search_when_heading_sigma_rad;
}

PoseSearch::PoseSearch(const LocalizerConfig& config, const matching::CorrelativeConfig& search) : config_(config), matcher_(search) {}

matching::SearchWindow PoseSearch::window_about(const UncertainPose2& prior) const {
  const auto reach = [&](int axis) { return config_.search_sigmas * std::sqrt(prior.covariance(axis, axis)); };
  const double farthest_m = config_.search_reach_m;  // beyond it there is no target, however unsure the prediction is
  return {std::min(reach(0), farthest_m), std::min(reach(1), farthest_m), std::min(reach(2), std::numbers::pi)};
}

std::vector<matching::Peak> PoseSearch::peaks_around(const UncertainPose2& prior, const std::vector<matching::MatchPoint>& points, const grids::SurfelMap& surfels) {
  const matching::SearchWindow window = window_about(prior);
  std::vector<matching::TargetPoint> targets;
  for (const grids::SurfelView& surfel : surfels.all()) {
    targets.push_back({static_cast<float>(surfel.mean_m.x()), static_cast<float>(surfel.mean_m.y()), 1.0F});
  }
  matcher_.set_target(targets, {prior.pose.translation_m(), config_.search_reach_m, config_.search_reach_m, std::max(window.half_x_m, window.half_y_m)});
  std::vector<Eigen::Vector2f> sources;
  for (const matching::MatchPoint& point : points) sources.push_back(point.in_base_m.cast<float>());
  return matcher_.search(sources, prior.pose, window);
}

}  // namespace slammot::localization
