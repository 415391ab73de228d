#include "services/tracking/box.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "common/geometry/pose2.hpp"
#include "services/tracking/projection.hpp"

namespace slammot::tracking {
namespace {

using Eigen::Vector2d;

std::optional<int> mirrored(std::optional<int> anchor) {
  return anchor ? std::optional(-*anchor) : std::nullopt;
}

double span_along_m(const Observation& observation, double heading_rad) {
  const Vector2d axis{std::cos(heading_rad), std::sin(heading_rad)};
  const Projection projection = span_of(observation, observation.points_m.front(), axis);
  return projection.high_m - projection.low_m;
}

}  // namespace

Box likely_box(double box_heading_rad, const Observation& observation, const TrackingConfig& config,
               const RoadUsers& road_users) {
  constexpr double kQuarterRad = 0.5 * std::numbers::pi;
  constexpr double kNarrowestM = 1.2;
  constexpr double kWidestFaceM = 2.6;  // a longer side is a flank
  const double longer_m = span_along_m(observation, box_heading_rad);
  const double shorter_m = span_along_m(observation, box_heading_rad + kQuarterRad);
  const bool is_face = longer_m > kNarrowestM * config.extent.size_scale &&
                       longer_m < kWidestFaceM * config.extent.size_scale &&
                       shorter_m < 0.5 * longer_m;
  Box box;
  box.road_users = &road_users;
  box.heading_rad = geometry::wrap_angle(box_heading_rad + (is_face ? kQuarterRad : 0.0));
  box.heading_variance_rad2 = is_face ? 0.3 : 0.1;
  box.is_oriented = longer_m > kWidestM * config.extent.size_scale;
  box.evidence.length.least_m = is_face ? shorter_m : longer_m;
  box.evidence.width.least_m = is_face ? longer_m : shorter_m;
  return with_likely_sizes(box, config);
}

Vector2d supposed_centre_m(const Box& box, const Observation& observation) {
  const Vector2d along{std::cos(box.heading_rad), std::sin(box.heading_rad)};
  const Vector2d across{-along.y(), along.x()};
  const Vector2d origin_m = observation.points_m.front();
  const Projection u = span_of(observation, origin_m, along);
  const Projection v = span_of(observation, origin_m, across);
  const Vector2d middle_m =
      origin_m + 0.5 * (u.low_m + u.high_m) * along + 0.5 * (v.low_m + v.high_m) * across;
  const Vector2d sight_m = middle_m - observation.laser_m;
  const double unseen_along_m = std::max(0.0, box.length.value_m - (u.high_m - u.low_m));
  const double unseen_across_m = std::max(0.0, box.width.value_m - (v.high_m - v.low_m));
  const bool is_face = u.high_m - u.low_m < v.high_m - v.low_m;
  const double back_along_m = is_face || std::abs(along.dot(sight_m)) > 0.5 * box.length.value_m
                                  ? 0.5 * unseen_along_m
                                  : 0.0;
  const double back_across_m = is_face ? 0.0 : 0.5 * unseen_across_m;
  return middle_m + std::copysign(back_along_m, along.dot(sight_m)) * along +
         std::copysign(back_across_m, across.dot(sight_m)) * across;
}

Box turned_by_a_quarter(Box box, double sense, const TrackingConfig& config) {
  box.heading_rad =
      geometry::wrap_angle(box.heading_rad + std::copysign(0.5 * std::numbers::pi, sense));
  box.heading_variance_rad2 = std::max(box.heading_variance_rad2, 0.3);
  std::swap(box.evidence.length, box.evidence.width);
  box.anchors = {};
  box.evidence.length.whole = {0.0, kUnknownSizeM2};  // measured along other sides
  box.evidence.width.whole = {0.0, kUnknownSizeM2};
  return with_likely_sizes(box, config);
}

Box turned_about(Box box) {
  box.heading_rad = geometry::wrap_angle(box.heading_rad + std::numbers::pi);
  box.anchors = {mirrored(box.anchors.length), mirrored(box.anchors.width)};
  return box;
}

bool is_plausible(const Box& box, const TrackingConfig& config) {
  return box.evidence.width.least_m < kWidestM * config.extent.size_scale &&
         box.evidence.length.least_m < config.extent.longest_body_m;
}

}  // namespace slammot::tracking
