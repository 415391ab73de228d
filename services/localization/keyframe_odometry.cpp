#include "services/localization/keyframe_odometry.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <Eigen/LU>

namespace slammot::localization {
namespace {

using geometry::Pose2;
using geometry::UncertainPose2;

constexpr double kRare_s = 0.3;              // between scans
constexpr double kFar_m = 1.0;               // from the keyframe,
constexpr double kFar_rad = 0.25;
constexpr double kLong_s = 1.0;              // after which what stands still is forgotten
constexpr double kReach_m = 50.0;            // half side of what is kept of the keyframe
constexpr double kLeastShare = 0.35;        // of the points
constexpr double kInformationShare = 0.4;    // neighbouring points share the errors of a surface
constexpr std::array kStarts{1.0, 0.75, 0.5, 0.0, 1.3};  // of the expected way: registration converges from half a metre only
constexpr double kMovesAlong = 0.35;         // of the way by odometry, and less
constexpr double kLeastWay_m = 0.1;
constexpr double kSame_m = 0.05;             // two registrations that end nearer to each other
constexpr double kRivalShare = 0.9;          // another place that fits as well as this share of the best: nothing is told
constexpr double kClearly = 2.2;             // times the fit of what is expected: the way was another; echoes from the ground move along
constexpr double kSure_m = 0.01;             // one sigma of what is expected, if it is right,
constexpr double kSureShare = 0.02;          // and what the way adds
constexpr double kSure_rad = 0.005;
constexpr double kExpected_m = 0.1;          // one sigma of what is expected,
constexpr double kExpectedShare = 0.5;       // and of the way and the turn
constexpr double kExpected_rad = 0.02;
constexpr double kFloor_m = 0.01;            // of what two scans tell
constexpr double kFloor_rad = 0.002;
constexpr double kMostEchoes = 1000.0;     // weight limit: more than a scan has

double squared(double value) { return value * value; }

}  // namespace

KeyframeOdometry::KeyframeOdometry(const LocalizerConfig& config) : match_(config.match), surfels_(grids::window_around(geometry::Vector2::Zero(), 2.0 * kReach_m, config.map.surfel_size_m), kMostEchoes) {
  match_.unproven_share = 1.0;
  match_.proven_after_m = 0.0;
  match_.new_below_m = 0.0;
  match_.information_share = kInformationShare;
  match_.body_sigma_m = config.body_sigma_without_wheels_m;
}

void KeyframeOdometry::resume(std::optional<Keyframe> keyframe) {
  keyframe_ = std::move(keyframe);
  surfels_.clear();
  if (!keyframe_) return;
  for (const geometry::Vector2& point_m : keyframe_->points_in_base_m) surfels_.add(point_m);
}

void KeyframeOdometry::begin(const Seen& seen) {
  if (!keyframe_) keyframe_.emplace();
  keyframe_->stamp_ns = seen.step.stamp_ns;
  keyframe_->wheel_from_base = *seen.step.wheel_from_base;
  keyframe_->odom_from_base = seen.odom_from_base;
  keyframe_->scanner_id = seen.scanner_id;
  keyframe_->points_in_base_m.clear();
  for (const matching::MatchPoint& point : seen.points.matched()) keyframe_->points_in_base_m.push_back(point.in_base_m);
  surfels_.clear();
  for (const geometry::Vector2& point_m : keyframe_->points_in_base_m) surfels_.add(point_m);
}

std::optional<UncertainPose2> KeyframeOdometry::registered(const Pose2& expected, const ScanPoints& points) {
  const double way_m = std::hypot(expected.x_m, expected.y_m);
  const double ahead_m = kExpected_m + kExpectedShare * way_m;
  const double turn_rad = kExpected_rad + kExpectedShare * std::abs(expected.heading_rad);
  const UncertainPose2 prior{expected, Eigen::Vector3d(squared(ahead_m), squared(kExpected_m), squared(turn_rad)).asDiagonal()};
  matching::PointToLineResult result;
  double best_fit = 0.0;
  double rival_fit = 0.0;
  for (const double share : kStarts) {
    const Pose2 start{share * expected.x_m, share * expected.y_m, expected.heading_rad};
    const matching::PointToLineResult one = matcher_.match(points.matched(), surfels_, prior, start, match_);
    const double fit = matching::fit_of(one, match_.robust_scale_m);
    const bool is_same = geometry::difference(one.map_from_base.pose, result.map_from_base.pose).head<2>().norm() < kSame_m;
    if (!is_same) rival_fit = std::max(rival_fit, std::min(fit, best_fit));
    if (fit <= best_fit) continue;
    best_fit = fit;
    result = one;
  }
  // What is expected has the first say: along a street many places fit a little better by chance.
  const UncertainPose2 sure{expected, Eigen::Vector3d(squared(kSure_m + kSureShare * way_m), squared(kSure_m + kSureShare * way_m), squared(kSure_rad)).asDiagonal()};
  const matching::PointToLineResult as_expected = matcher_.match(points.matched(), surfels_, sure, expected, match_);
  const bool is_clearly_elsewhere = best_fit > kClearly * matching::fit_of(as_expected, match_.robust_scale_m);
  if (!is_clearly_elsewhere) result = as_expected;
  if (result.matched_share < kLeastShare || (is_clearly_elsewhere && rival_fit > kRivalShare * best_fit)) return std::nullopt;
  const Pose2 optimum = sensing::scan_optimum(is_clearly_elsewhere ? prior : sure, result.map_from_base.pose, result.scan_information);
  geometry::Matrix3 information = result.scan_information;
  information.diagonal() += Eigen::Vector3d(1e-2, 1e-2, 1e-2);
  geometry::Matrix3 covariance = information.inverse();
  covariance.diagonal() += Eigen::Vector3d(squared(kFloor_m), squared(kFloor_m), squared(kFloor_rad));
  return UncertainPose2{optimum, covariance};
}

std::optional<KeyframeOdometry::Comparison> KeyframeOdometry::observe(const Seen& seen) {
  const Step& step = seen.step;
  if (!step.wheel_from_base || step.usual_duration_s > kRare_s) {
    keyframe_.reset();
    return std::nullopt;
  }
  if (!keyframe_) {
    begin(seen);
    last_.reset();
    return std::nullopt;
  }
  if (keyframe_->scanner_id != seen.scanner_id) return std::nullopt;
  if (keyframe_->stamp_ns == step.stamp_ns) return last_;
  const Pose2 by_wheels = geometry::inverse(keyframe_->wheel_from_base) * *step.wheel_from_base;
  const Pose2 expected = geometry::inverse(keyframe_->odom_from_base) * seen.odom_from_base;
  const double way_m = std::max(std::hypot(by_wheels.x_m, by_wheels.y_m), std::hypot(expected.x_m, expected.y_m));
  const double turn_rad = std::max(std::abs(by_wheels.heading_rad), std::abs(expected.heading_rad));
  const double duration_s = static_cast<double>(step.stamp_ns - keyframe_->stamp_ns) * 1e-9;
  if (way_m < kFar_m && turn_rad < kFar_rad && duration_s < kLong_s) return std::nullopt;
  auto by_scans = registered(expected, seen.points);
  begin(seen);
  // Traffic on all sides, and the ground that a braking scanner sees, move along: that the vehicle stands is not told by a pair of scans.
  const double way_by_wheels_m = by_wheels.translation_m().norm();
  if (by_scans && way_by_wheels_m > kLeastWay_m && by_scans->pose.translation_m().norm() < kMovesAlong * way_by_wheels_m) by_scans.reset();
  last_ = Comparison{by_wheels, by_scans, duration_s};
  return last_;
}

}  // namespace slammot::localization
