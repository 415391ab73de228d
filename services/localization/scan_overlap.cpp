#include "services/localization/scan_overlap.hpp"

#include <algorithm>

#include "services/localization/keyframe_priors.hpp"

namespace slammot::localization {
namespace {

constexpr double kMostReach_m = 250.0;        // the grid of one scan holds no more
constexpr double kMostEchoesOfScan = 1000.0;  // weight limit: more than a scan has

}  // namespace

ScanOverlap::ScanOverlap(const LocalizerConfig& config)
    : robust_scale_m_(config.match.robust_scale_m),
      match_(config.match),
      surfels_(grids::window_around(geometry::Vector2::Zero(),
                                    2.0 * std::min(config.echoes.match_range_m, kMostReach_m),
                                    config.map.surfel_size_m),
               kMostEchoesOfScan) {
  match_.unproven_share = 1.0;
  match_.proven_after_m = 0.0;
}

void ScanOverlap::map_points(const ScanPoints& points) {
  surfels_.clear();
  for (const matching::MatchPoint& point : points.matched()) surfels_.add(point.in_base_m);
}

double ScanOverlap::before_on_scan(const ScanPoints& points,
                                   const geometry::Pose2& now_from_before) {
  const geometry::UncertainPose2 prior = about(now_from_before);
  return matching::fit_of(
      matcher_.match(points.matched_before(), surfels_, prior, prior.pose, match_),
      robust_scale_m_);
}

}  // namespace slammot::localization
