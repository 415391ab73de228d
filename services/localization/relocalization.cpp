#include "services/localization/relocalization.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>

#include "services/localization/map_agreement.hpp"

namespace slammot::localization {
namespace {

using geometry::UncertainPose2;

constexpr double kFoundShare = 0.6;  // Lost, it has found itself again where so many points match.

constexpr double kWindowPerScan_m = 2.0;  // the longer it is lost, the wider it looks
constexpr unsigned kScansBetweenWideSearches = 16;
constexpr std::size_t kPosesLookedAt = 4;  // that are looked at
constexpr double kRivalRatio = 0.98;  // with another pose that is as good as this it waits for a
                                      // scan that tells

/// A wide search costs as much as hundreds of matches.
bool is_worth_a_search(unsigned lost_scans) {
  return std::has_single_bit(lost_scans) || lost_scans % kScansBetweenWideSearches == 0;
}

bool are_same(const geometry::Pose2& a, const geometry::Pose2& b) {
  constexpr double kSame_m = 0.3;
  constexpr double kSame_rad = 0.1;
  const Eigen::Vector3d apart = geometry::difference(a, b);
  return apart.head<2>().norm() < kSame_m && std::abs(apart.z()) < kSame_rad;
}

}  // namespace

Relocalization::Relocalization(const LocalizerConfig& config)
    : config_(config), search_(config, kPosesLookedAt) {}

/// Whichever way it looks now: a room looks much the same from both of its ends, and only all the
/// answers together tell.
UncertainPose2 Relocalization::anywhere_about(const UncertainPose2& prior, int lost_scans) const {
  const double sigma_m =
      std::min(kWindowPerScan_m * lost_scans, config_.search.reach_m) / config_.search.sigmas;
  UncertainPose2 anywhere = prior;
  anywhere.covariance.diagonal() += Eigen::Vector3d(sigma_m, sigma_m, std::numbers::pi).cwiseAbs2();
  return anywhere;
}

Relocalization::Candidate Relocalization::registered(const geometry::Pose2& about,
                                                     const geometry::Matrix3& covariance,
                                                     const ScanPoints& points, const LocalMap& map,
                                                     const ScanToMatch& scan,
                                                     ScanMatcher& matcher) const {
  const matching::PointToLineResult result =
      matcher.register_from(about, {about, covariance}, scan);
  const double contradicted =
      agreement(points, result.map_from_base.pose, map.evidence(), config_.map)
          .contradicting_share();
  if (result.matched_share < kFoundShare || contradicted > kFoundByHalf * kMostContradictedShare)
    return {};
  return {.match = {.odom_from_base = result.map_from_base,
                    .is_believed = true,
                    .rms_residual_m = result.rms_residual_m},
          .quality = result.matched_share * (1.0 - contradicted)};
}

RelocalizationResult Relocalization::find(int lost_scans, const Step& step,
                                          const ScanPoints& points, const LocalMap& map,
                                          ScanMatcher& matcher) {
  if (!is_worth_a_search(static_cast<unsigned>(lost_scans))) return {};
  const UncertainPose2 anywhere = anywhere_about(step.prior(), lost_scans);
  Candidate best;
  double rival_quality = 0.0;
  for (const geometry::Pose2& pose :
       search_.poses_around(anywhere, points.matched(), map.surfels())) {
    const Candidate candidate = registered(pose, anywhere.covariance, points, map,
                                           {points.matched(), map.surfels(), step}, matcher);
    if (candidate.quality == 0.0) continue;
    const bool is_same = best.quality > 0.0 && are_same(best.match.odom_from_base.pose,
                                                        candidate.match.odom_from_base.pose);
    if (!is_same)
      rival_quality = std::max(rival_quality, std::min(candidate.quality, best.quality));
    if (candidate.quality > best.quality) best = candidate;
  }
  if (best.quality == 0.0 || rival_quality > kRivalRatio * best.quality)
    return {.has_searched = true, .found = {}};
  return {.has_searched = true, .found = best.match};
}

}  // namespace slammot::localization
