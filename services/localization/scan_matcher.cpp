#include "services/localization/scan_matcher.hpp"

#include <algorithm>

namespace slammot::localization {
namespace {

using geometry::Pose2;
using geometry::UncertainPose2;

/// Scans that are far apart in time err nearly independently, and see a place once or twice:
/// nothing is proven there, and all counts.
matching::PointToLineConfig spaced(matching::PointToLineConfig config, double step_s) {
  constexpr double kDependent_s = 0.1;
  constexpr double kIndependent_s = 0.5;
  constexpr double kIndependentScanShare = 0.8;
  const double apart =
      std::clamp((step_s - kDependent_s) / (kIndependent_s - kDependent_s), 0.0, 1.0);
  config.information_share = std::max(config.information_share, kIndependentScanShare * apart);
  config.proven_after_m *= 1.0 - apart;
  return config;
}

constexpr matching::SearchWindow kAboutCoarse{0.6, 0.6, 0.1};  // what the cells of a bounded search
                                                               // leave open
constexpr double kCoarsePriorSigmas = 2.0;  // without wheels: so far off is a prediction while the
                                            // vehicle begins to turn

}  // namespace

ScanMatcher::ScanMatcher(const LocalizerConfig& config, work::SideWork* help)
    : config_(config),
      without_wheels_(config.match),
      by_scans_alone_(config.match),
      search_(config.search.correlative),
      search_far_(config, 1),
      matcher_(help) {
  without_wheels_.unproven_share = 1.0;
  without_wheels_.information_share = 1.0;
  by_scans_alone_.information_share = 1.0;
  by_scans_alone_.body_sigma_m = config.trust.body_sigma_without_wheels_m;
  by_scans_alone_.coarse_prior_sigmas = kCoarsePriorSigmas;
}

/// Where the wheels' turns are noise, scans tell the turn, and a car that drives off before the
/// vehicle must not turn it.
matching::PointToLineConfig ScanMatcher::beside_wheels(const Step& step) const {
  matching::PointToLineConfig config = spaced(config_.match, step.usual_duration_s);
  if (step.wheels.turn_variance_rad2 > 0.0)
    config.body_sigma_m = config_.trust.body_sigma_without_wheels_m;
  return config;
}

/// A single step that wheels are silent or wrong about may be one into what nobody has seen before:
/// what is new counts in full. Without any wheels it would make the map of its own lag: where each
/// scan is matched against the last one, nothing tells how slow it has become.
matching::PointToLineConfig ScanMatcher::config_for(const Step& step) const {
  switch (step.source) {
    case StepSource::kOdometry:
    case StepSource::kReach: return beside_wheels(step);
    case StepSource::kVelocityThisOnce: return without_wheels_;
    case StepSource::kVelocityAlone: break;
  }
  return by_scans_alone_;
}

matching::PointToLineResult ScanMatcher::register_from(const Pose2& odom_from_base,
                                                       const UncertainPose2& prior,
                                                       const ScanToMatch& scan) {
  matching::PointToLineConfig where_it_is = config_for(scan.step);
  if (!(odom_from_base == prior.pose)) where_it_is.coarse_prior_sigmas = 0.0;
  return matcher_.match(scan.points, scan.surfels, prior, odom_from_base, where_it_is);
}

/// The best pose in the window; the middle where nothing scores. Exact.
Pose2 ScanMatcher::found_in(const matching::SearchWindow& window, const Pose2& middle,
                            const ScanToMatch& scan) {
  std::vector<matching::TargetPoint> targets;
  for (const grids::SurfelView& surfel : scan.surfels.all())
    targets.push_back(
        {static_cast<float>(surfel.mean_m.x()), static_cast<float>(surfel.mean_m.y()), 1.0F});
  search_.set_target(targets, {middle.translation_m(), config_.search.reach_m,
                               config_.search.reach_m, std::max(window.half_x_m, window.half_y_m)});
  std::vector<Eigen::Vector2f> sources;
  for (const matching::MatchPoint& point : scan.points)
    sources.push_back(point.in_base_m.cast<float>());
  const std::vector<matching::Peak> peaks = search_.search(sources, middle, window);
  return peaks.empty() ? middle : peaks.front().target_from_source;
}

/// The best pose within the prior's reach; the prior's own where nothing scores. Within a wide one
/// about where the bounded search finds it.
Pose2 ScanMatcher::found_around(const UncertainPose2& prior, const ScanToMatch& scan) {
  const matching::SearchWindow window = search_window(prior, config_);
  if (!search_far_.is_coarse_in(window)) return found_in(window, prior.pose, scan);
  const std::vector<Pose2> poses = search_far_.poses_around(prior, scan.points, scan.surfels);
  return poses.empty() ? prior.pose : found_in(kAboutCoarse, poses.front(), scan);
}

/// What a search has found is not as far off as the prediction was.
matching::PointToLineResult ScanMatcher::match_from_search(const ScanToMatch& scan) {
  const UncertainPose2 prior = scan.step.prior();
  matching::PointToLineConfig where_it_is = config_for(scan.step);
  where_it_is.coarse_prior_sigmas = 0.0;
  return matcher_.match(scan.points, scan.surfels, prior, found_around(prior, scan), where_it_is);
}

ScanMatch ScanMatcher::match(const ScanToMatch& scan) {
  const UncertainPose2 prior = scan.step.prior();
  if (scan.points.size() < kFewestEchoes) return {.odom_from_base = prior};
  // Along a featureless wall a search finds any place as good as any other.
  const bool is_unsure = is_vague(prior, config_);
  bool searches = is_unsure && !scan.step.last_was_sampled && !scan.registered;
  matching::PointToLineResult result;
  if (scan.registered) {
    result = *scan.registered;
  } else if (!searches) {
    result = register_from(prior.pose, prior, scan);
    searches = is_unsure && !says_little(result.scan_information, config_.trust.ambiguous);
  }
  if (searches) result = match_from_search(scan);
  if (result.matched_share < config_.trust.least_matched_share)
    return {.odom_from_base = prior, .is_lost = true, .was_searched = searches};
  ScanMatch found{.odom_from_base = result.map_from_base,
                  .is_believed = true,
                  .was_searched = searches,
                  .rms_residual_m = result.rms_residual_m,
                  .matched_share = result.matched_share};
  found.was_sampled = says_little(result.scan_information, config_.trust.ambiguous);
  if (found.was_sampled) {
    found.odom_from_base =
        ambiguous_matcher_.match({scan.points, scan.surfels, prior, result},
                                 config_.trust.ambiguous, config_for(scan.step), scan.sequence);
  } else {
    found.new_share = result.new_share;
  }
  return found;
}

}  // namespace slammot::localization
