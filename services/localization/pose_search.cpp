#include "services/localization/pose_search.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>

namespace slammot::localization {
namespace {

using geometry::UncertainPose2;
using geometry::Vector2;

constexpr std::size_t kMostPoints = 150;  // neighbours lie on the same surface
constexpr double kLeastPeakRatio = 0.7;
constexpr double kMostPoses = 3e5;  // of the search grid; a wider window is searched by larger
                                    // cells
constexpr std::uint64_t kMostWork = 3'000'000;  // cells read: some milliseconds
// Surfaces are known by one point a surfel: between these, too, a point lies on the surface.
constexpr double kSurfelsPerCell = 0.4;
constexpr double kSurfelsPerSmear = 0.5;

}  // namespace

bool is_vague(const UncertainPose2& prior, const LocalizerConfig& config) {
  const double position_m2 = std::max(prior.covariance(0, 0), prior.covariance(1, 1));
  return position_m2 > config.search.when_sigma_m * config.search.when_sigma_m ||
         prior.covariance(2, 2) >
             config.search.when_heading_sigma_rad * config.search.when_heading_sigma_rad;
}

PoseSearch::PoseSearch(const LocalizerConfig& config, std::size_t max_peaks)
    : config_(config), max_peaks_(max_peaks) {}

matching::SearchWindow search_window(const UncertainPose2& prior, const LocalizerConfig& config) {
  const auto reach = [&](int axis) {
    return config.search.sigmas * std::sqrt(prior.covariance(axis, axis));
  };
  const double farthest_m = config.search.reach_m;  // beyond it there is no target, however unsure
                                                    // the prediction is
  return {std::min(reach(0), farthest_m), std::min(reach(1), farthest_m),
          std::min(reach(2), std::numbers::pi)};
}

double PoseSearch::finest_cell_m() const {
  return std::max(config_.search.correlative.resolution_m,
                  kSurfelsPerCell * config_.map.surfel_size_m);
}

bool PoseSearch::is_coarse_in(const matching::SearchWindow& window) const {
  return cell_m_for(window) > finest_cell_m();
}

double PoseSearch::cell_m_for(const matching::SearchWindow& window) const {
  const double finest_m = finest_cell_m();
  const double volume_m3 = 8.0 * std::max(window.half_x_m, finest_m) *
                           std::max(window.half_y_m, finest_m) *
                           std::max(window.half_heading_rad * config_.search.reach_m, finest_m);
  return std::max(finest_m, std::cbrt(volume_m3 / kMostPoses));
}

std::vector<Eigen::Vector2f> PoseSearch::thinned(
    const std::vector<matching::MatchPoint>& points) const {
  std::vector<Eigen::Vector2f> thinned;
  const std::size_t step = points.size() / kMostPoints + 1;
  for (std::size_t i = 0; i < points.size(); i += step) {
    if (points[i].in_base_m.norm() < config_.search.reach_m)
      thinned.push_back(points[i].in_base_m.cast<float>());
  }
  return thinned;
}

std::vector<matching::TargetPoint> PoseSearch::targets_about(
    const Vector2& centre_m, const grids::SurfelMap& surfels) const {
  std::vector<matching::TargetPoint> targets;
  for (const grids::SurfelView& surfel : surfels.all()) {
    if ((surfel.mean_m - centre_m).lpNorm<Eigen::Infinity>() > config_.search.reach_m) continue;
    targets.push_back(
        {static_cast<float>(surfel.mean_m.x()), static_cast<float>(surfel.mean_m.y()), 1.0F});
  }
  return targets;
}

std::vector<geometry::Pose2> PoseSearch::poses_around(
    const UncertainPose2& prior, const std::vector<matching::MatchPoint>& points,
    const grids::SurfelMap& surfels) {
  const matching::SearchWindow window = search_window(prior, config_);
  const double cell_m = cell_m_for(window);
  const std::vector<matching::TargetPoint> targets =
      targets_about(prior.pose.translation_m(), surfels);
  if (targets.empty()) return {};
  const double smear_m = std::max({config_.search.correlative.smear_sigma_m,
                                   kSurfelsPerSmear * config_.map.surfel_size_m, cell_m});
  const int level = matching::WideSearch::useful_level(window, cell_m);
  matching::WideSearch search(
      thinned(points), cell_m,
      {.min_score = config_.search.correlative.min_score,
       .max_peaks = max_peaks_,
       .min_peak_ratio = kLeastPeakRatio,
       .peak_separation_m = config_.search.correlative.peak_separation_m,
       .peak_separation_rad = config_.search.correlative.peak_separation_rad});
  search.add_target({std::make_shared<matching::ScorePyramid>(targets, cell_m, smear_m, level),
                     prior.pose, window, geometry::Pose2::identity()});
  search.advance(kMostWork);
  std::vector<geometry::Pose2> poses;
  for (const matching::WidePeak& peak : search.peaks()) poses.push_back(peak.target_from_source);
  return poses;
}

}  // namespace slammot::localization
