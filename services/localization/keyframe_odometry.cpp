#include "services/localization/keyframe_odometry.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <Eigen/LU>

#include "services/localization/keyframe_priors.hpp"

namespace slammot::localization {
namespace {

using geometry::Pose2;
using geometry::UncertainPose2;

constexpr double kFar_m = 1.0;  // from the keyframe,
constexpr double kFar_rad = 0.25;
constexpr double kLong_s = 1.0;            // after which what stands still is forgotten
constexpr double kReach_m = 50.0;          // half side of what is kept of the keyframe
constexpr double kInformationShare = 0.4;  // neighbouring points share the errors of a surface
constexpr std::array kStarts{1.0, 0.75, 0.5, 0.0, 1.3};  // of the expected way: registration
                                                         // converges from half a metre only
constexpr double kMovesAlong = 0.35;                     // of the way by odometry, and less
constexpr double kLeastWay_m = 0.1;
constexpr double kBestFit = 0.9;   // of any place
constexpr double kClearly = 2.2;   // times the fit of what is expected: the way was another; echoes
                                   // from the ground move along
constexpr double kStands_m = 0.3;  // by odometry between two keyframes
constexpr std::int64_t kRest_ns = 200'000'000;
constexpr double kSoundAbove = 0.9;
constexpr double kDoubtBelow = 0.05;  // probability that the way by odometry is right
constexpr double kProminent = 0.06;   // of a fit
constexpr double kDoubtOdds = 2.0;
constexpr double kIndependent_s = 0.1;  // scans less far apart in time meet the same traffic
constexpr double kStill_m = 0.01;
constexpr double kStill_rad = 0.002;
constexpr double kLongStanding_s = 0.4;  // between two keyframes: a car that sets off is then
                                         // within reach of a match
constexpr double kStops_s = 0.1;  // without motion by the wheels: one step may be less than a tick
constexpr std::int64_t kAgain_ns = 200'000'000;
constexpr double kPatience_s = 4.0;     // with one keyframe
constexpr double kAsWell = 0.97;        // of the fit
constexpr double kExpectedShare = 0.5;  // and of the way and the turn
constexpr double kMostEchoes = 1000.0;  // weight limit: more than a scan has

bool stands(const Pose2& moved) {
  return std::hypot(moved.x_m, moved.y_m) < kStill_m && std::abs(moved.heading_rad) < kStill_rad;
}

/// At the scan that tells that the wheels do not count any more.
bool has_stopped_now(const Step& step) {
  return step.wheels.stood_s >= kStops_s && step.wheels.stood_s - step.duration_s < kStops_s;
}

bool is_far(const Pose2& moved) {
  return std::hypot(moved.x_m, moved.y_m) >= kFar_m || std::abs(moved.heading_rad) >= kFar_rad;
}

}  // namespace

KeyframeOdometry::KeyframeOdometry(const LocalizerConfig& config)
    : match_(config.match),
      surfels_(
          grids::window_around(geometry::Vector2::Zero(), 2.0 * kReach_m, config.map.surfel_size_m),
          kMostEchoes),
      nats_(kInformationShare * config.belief.share_nats) {
  match_.unproven_share = 1.0;
  match_.proven_after_m = 0.0;
  match_.new_below_m = 0.0;
  match_.information_share = kInformationShare;
  match_.body_sigma_m = config.trust.body_sigma_without_wheels_m;
}

void KeyframeOdometry::resume(State state) {
  state_ = std::move(state);
  last_.reset();
  map_keyframe();
}

void KeyframeOdometry::map_keyframe() {
  surfels_.clear();
  if (!state_.keyframe) return;
  for (const geometry::Vector2& point_m : state_.keyframe->points_in_base_m) surfels_.add(point_m);
}

void KeyframeOdometry::begin(const Seen& seen) {
  if (!state_.keyframe) state_.keyframe = Keyframe{};
  state_.rests = false;
  state_.keyframe->stamp_ns = seen.step.stamp_ns;
  state_.keyframe->wheel_from_base = *seen.step.wheels.wheel_from_base;
  state_.keyframe->odom_from_base = seen.odom_from_base;
  state_.keyframe->scanner_id = seen.scanner_id;
  state_.keyframe->points_in_base_m.clear();
  for (const matching::MatchPoint& point : seen.points.matched())
    state_.keyframe->points_in_base_m.push_back(point.in_base_m);
  map_keyframe();
}

matching::PointToLineResult KeyframeOdometry::registered_about(const UncertainPose2& expected,
                                                               const ScanPoints& points) {
  return matcher_.match(points.matched(), surfels_, expected, expected.pose, match_);
}

KeyframeOdometry::BestPlace KeyframeOdometry::best_place(const UncertainPose2& prior,
                                                         const ScanPoints& points) {
  BestPlace best;
  for (const double share : kStarts) {
    const Pose2 start{share * prior.pose.x_m, share * prior.pose.y_m, prior.pose.heading_rad};
    const matching::PointToLineResult one =
        matcher_.match(points.matched(), surfels_, prior, start, match_);
    const double fit = matching::fit_of(one, match_.robust_scale_m);
    const bool is_same =
        geometry::difference(one.map_from_base.pose, best.registered.map_from_base.pose)
            .head<2>()
            .norm() < kSame_m;
    if (!is_same) best.rival_fit = std::max(best.rival_fit, std::min(fit, best.fit));
    if (fit <= best.fit) continue;
    best.fit = fit;
    best.registered = one;
  }
  return best;
}

/// expected: by the estimate; by_wheels: with all that is known of odometry applied.
std::optional<UncertainPose2> KeyframeOdometry::registered(const Pose2& expected,
                                                           const Pose2& by_wheels,
                                                           const ScanPoints& points) {
  if (points.independent() < kFewestPoints) return std::nullopt;
  const double way_m = std::hypot(expected.x_m, expected.y_m);
  const double ahead_m = kExpected_m + kExpectedShare * way_m;
  const double turn_rad = kExpected_rad + kExpectedShare * std::abs(expected.heading_rad);
  const UncertainPose2 prior{
      expected,
      Eigen::Vector3d(squared(ahead_m), squared(kExpected_m), squared(turn_rad)).asDiagonal()};
  // What is expected has the first say: along a street many places fit a little better by chance.
  UncertainPose2 sure = surely(expected, way_m);
  matching::PointToLineResult as_expected = registered_about(sure, points);
  // An estimate that has gone astray confirms itself where places look alike: odometry that fits as
  // well is right.
  const UncertainPose2 by_odometry = surely(by_wheels, way_m);
  const matching::PointToLineResult as_by_wheels = registered_about(by_odometry, points);
  if (matching::fit_of(as_by_wheels, match_.robust_scale_m) >
      kAsWell * matching::fit_of(as_expected, match_.robust_scale_m)) {
    as_expected = as_by_wheels;
    sure = by_odometry;
  }
  const double expected_fit = matching::fit_of(as_expected, match_.robust_scale_m);
  const bool may_be_elsewhere = expected_fit * kClearly < kBestFit;
  const BestPlace best = may_be_elsewhere ? best_place(prior, points) : BestPlace{};
  const bool is_clearly_elsewhere = best.fit > kClearly * expected_fit;
  const matching::PointToLineResult& result = is_clearly_elsewhere ? best.registered : as_expected;
  if (result.matched_share < kLeastShare ||
      (is_clearly_elsewhere && best.rival_fit > kRivalShare * best.fit))
    return std::nullopt;
  const Pose2 optimum = sensing::scan_optimum(is_clearly_elsewhere ? prior : sure,
                                              result.map_from_base.pose, result.scan_information);
  geometry::Matrix3 information = result.scan_information;
  information.diagonal() += Eigen::Vector3d(1e-2, 1e-2, 1e-2);
  return with_floor({optimum, information.inverse()});
}

/// How well the points lie on the keyframe's at these very poses.
std::span<const double> KeyframeOdometry::fits_at(double heading_rad,
                                                  std::span<const geometry::Vector2> positions_m,
                                                  const ScanPoints& points) {
  return fit_profile_.fits_at(points.matched(), surfels_, heading_rad, positions_m, match_);
}

std::optional<UncertainPose2> KeyframeOdometry::registered_near(const Pose2& pose,
                                                                const ScanPoints& points) {
  const matching::PointToLineResult result = registered_about(about(pose), points);
  if (result.matched_share < kLeastShare) return std::nullopt;
  return with_floor(result.map_from_base);
}

/// Compares shares of the way by odometry with each other: registration from what is expected
/// hardly leaves it. A fast vehicle has a comparison at every other scan: together they count as
/// much as those that are independent.
void KeyframeOdometry::judge_way(const Pose2& by_wheels, const ScanPoints& points,
                                 sensing::OdometryComparison& comparison) {
  const double way_m = by_wheels.translation_m().norm();
  const double heading_rad =
      comparison.by_scans ? comparison.by_scans->pose.heading_rad : by_wheels.heading_rad;
  const double direction_rad =
      std::atan2(by_wheels.y_m, by_wheels.x_m) + 0.5 * (heading_rad - by_wheels.heading_rad);
  const auto pose_at = [&](double ratio) {
    return Pose2{ratio * way_m * std::cos(direction_rad), ratio * way_m * std::sin(direction_rad),
                 heading_rad};
  };
  std::array<geometry::Vector2, sensing::WayRatioFilter::kRatios.size()> positions_m;
  std::ranges::transform(sensing::WayRatioFilter::kRatios, positions_m.begin(),
                         [&](double ratio) { return pose_at(ratio).translation_m(); });
  sensing::WayRatioFilter::Profile fits;
  std::ranges::copy(fits_at(heading_rad, positions_m, points), fits.begin());
  fits = sensing::WayRatioFilter::prominent(fits, kProminent);
  const double nats =
      nats_ * points.evidence_share() * std::min(1.0, comparison.duration_s / kIndependent_s);
  for (double& fit : fits) fit *= nats;
  state_.way_ratio.update(fits);
  if (state_.way_ratio.sound_probability() > kDoubtBelow) return;
  comparison.by_scans = registered_near(pose_at(state_.way_ratio.most_likely_ratio()), points);
  if (comparison.by_scans) comparison.extra_odds = -kDoubtOdds;
}

std::optional<sensing::OdometryComparison> KeyframeOdometry::observe(const Seen& seen) {
  const Step& step = seen.step;
  if (!step.wheels.wheel_from_base || step.usual_duration_s > sensing::kRareScans_s) {
    state_.keyframe.reset();
    state_.compared_ns.reset();
    return std::nullopt;
  }
  if (state_.compared_ns == step.stamp_ns) return last_;
  if (step.wheels.have_changed) {
    // Before and after the change odometry may have different factors: a comparison across it
    // would mix them.
    state_.way_ratio.doubt();
    state_.is_in_doubt = true;
    begin(seen);
    return std::nullopt;
  }
  if (has_stopped_now(step)) {
    // What the wheels say from here on is judged by itself: the vehicle may go on.
    begin(seen);
    return std::nullopt;
  }
  if (!state_.keyframe || state_.rests) {
    if (!state_.compared_ns || state_.is_in_doubt ||
        step.stamp_ns - *state_.compared_ns >= kRest_ns)
      begin(seen);
    return std::nullopt;
  }
  if (state_.keyframe->scanner_id != seen.scanner_id) return std::nullopt;
  const Pose2 by_wheels =
      geometry::inverse(state_.keyframe->wheel_from_base) * *step.wheels.wheel_from_base;
  const Pose2 expected = geometry::inverse(state_.keyframe->odom_from_base) * seen.odom_from_base;
  const double duration_s = static_cast<double>(step.stamp_ns - state_.keyframe->stamp_ns) * 1e-9;
  const bool is_still =
      stands(by_wheels) && !is_far(expected) && !seen.prediction.state().belief.is_disbelieved;
  const double long_s = is_still ? kLongStanding_s : kLong_s;
  if (!is_far(by_wheels) && !is_far(expected) && duration_s < long_s) return std::nullopt;
  if (is_still && state_.compared_ns && step.stamp_ns - *state_.compared_ns < kAgain_ns)
    return std::nullopt;
  return compare(seen, {by_wheels, expected, duration_s, is_still});
}

sensing::OdometryComparison KeyframeOdometry::compare(const Seen& seen,
                                                      const SinceKeyframe& motion) {
  const Pose2 as_believed = seen.prediction.as_believed(motion.by_wheels, motion.duration_s);
  last_ = sensing::OdometryComparison{motion.by_wheels, as_believed,
                                      registered(motion.expected, as_believed, seen.points),
                                      motion.duration_s};
  Standing standing = Standing::kConfirmed;
  if (as_believed.translation_m().norm() > kStands_m) judge_way(as_believed, seen.points, *last_);
  else if (motion.is_still) standing = judge_standing(as_believed, seen.points, *last_);
  state_.compared_ns = seen.step.stamp_ns;
  if (motion.is_still && standing == Standing::kUnclear && motion.duration_s < kPatience_s) {
    state_.is_in_doubt = true;  // the next scans are compared with the same place
    return *last_;
  }
  // Sound odometry is looked at a few times a second only.
  state_.is_in_doubt = !last_->by_scans || last_->extra_odds != 0.0 ||
                       state_.way_ratio.sound_probability() < kSoundAbove;
  if (state_.is_in_doubt) begin(seen);
  else state_.rests = true;
  auto& by_scans = last_->by_scans;
  // Traffic on all sides, and the ground that a braking scanner sees, move along: that the vehicle
  // stands is not told by a pair of scans.
  const double way_by_wheels_m = motion.by_wheels.translation_m().norm();
  if (by_scans && way_by_wheels_m > kLeastWay_m &&
      by_scans->pose.translation_m().norm() < kMovesAlong * way_by_wheels_m)
    by_scans.reset();
  return *last_;
}

}  // namespace slammot::localization
