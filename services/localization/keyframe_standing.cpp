#include <algorithm>
#include <array>
#include <cmath>

#include "services/localization/keyframe_odometry.hpp"
#include "services/localization/keyframe_priors.hpp"

namespace slammot::localization {
namespace {

using geometry::Pose2;

constexpr std::array kTurnsOfStanding_rad{0.0, -0.03, 0.03};
constexpr double kWayStep_m = 0.1;
constexpr double kBackwards_m = -1.0;
constexpr double kForwards_m = 2.0;
constexpr double kApart_m = 0.4;      // another place
constexpr double kStandsAbove = 0.6;  // share of the points: nothing else is looked for
constexpr double kStandsShare = 0.5;
constexpr double kClearlyDrives = 5.0;  // nats

}  // namespace

/// Where along the vehicle's axis the points lie best on the keyframe's, and how well they do
/// elsewhere.
KeyframeOdometry::PlaceAhead KeyframeOdometry::place_ahead(const Pose2& by_wheels,
                                                           const ScanPoints& points) {
  constexpr auto kPlaces = static_cast<std::size_t>((kForwards_m - kBackwards_m) / kWayStep_m) + 1;
  PlaceAhead best;
  std::array<double, kPlaces> most{};  // of any heading
  std::array<geometry::Vector2, kPlaces> positions_m;
  for (std::size_t i = 0; i < kPlaces; ++i)
    positions_m[i] = {by_wheels.x_m + kBackwards_m + kWayStep_m * static_cast<double>(i),
                      by_wheels.y_m};
  for (const double turn_rad : kTurnsOfStanding_rad) {
    const double heading_rad = by_wheels.heading_rad + turn_rad;
    const std::span<const double> fits = fits_at(heading_rad, positions_m, points);
    for (std::size_t i = 0; i < kPlaces; ++i) {
      most[i] = std::max(most[i], fits[i]);
      if (fits[i] <= best.fit) continue;
      best.fit = fits[i];
      best.pose = {positions_m[i].x(), positions_m[i].y(), heading_rad};
    }
  }
  for (std::size_t i = 0; i < kPlaces; ++i)
    if (std::abs(positions_m[i].x() - best.pose.x_m) > kApart_m)
      best.rival_fit = std::max(best.rival_fit, most[i]);
  return best;
}

/// Wheels that stand while the vehicle begins to drive. Traffic that sets off on both sides moves
/// along, too: what stands must explain less than half of what another place does.
KeyframeOdometry::Standing KeyframeOdometry::judge_standing(
    const Pose2& by_wheels, const ScanPoints& points, sensing::OdometryComparison& comparison) {
  if (comparison.by_scans && !sensing::both_stand(comparison))
    comparison.odom_from_keyframe = state_.keyframe->odom_from_base;
  const double standing_share = registered_about(surely(by_wheels, 0.0), points).matched_share;
  if (standing_share > kStandsAbove)
    return comparison.odom_from_keyframe ? Standing::kUnclear : Standing::kConfirmed;
  const PlaceAhead best = place_ahead(by_wheels, points);
  const matching::PointToLineResult there = registered_about(about(best.pose), points);
  const double moved_m =
      (there.map_from_base.pose.translation_m() - by_wheels.translation_m()).norm();
  if (moved_m < kSame_m) return Standing::kConfirmed;
  const bool is_refuted = points.independent() >= kFewestPoints &&
                          standing_share < kStandsShare * there.matched_share &&
                          there.matched_share >= kLeastShare &&
                          best.rival_fit < kRivalShare * best.fit;
  if (!is_refuted) return Standing::kUnclear;
  comparison.by_scans = with_floor(there.map_from_base);
  comparison.extra_odds = -kClearlyDrives;
  comparison.odom_from_keyframe = state_.keyframe->odom_from_base;
  return Standing::kRefuted;
}

}  // namespace slammot::localization
