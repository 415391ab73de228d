#include "services/tracking/body.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "services/tracking/tracking_config.hpp"

namespace slammot::tracking {
namespace {

using Eigen::Matrix2d;
using Eigen::Vector2d;

constexpr double kFaceDepthM = 0.2;       ///< Points this near the outermost one lie on the same side.
constexpr double kLeastShareSeen = 0.5;   ///< Of a side that should be in view, for its end to count as seen.
constexpr double kFewestBeams = 3.0;       ///< That a side should return, for its end to count as seen.
constexpr double kUnknownSigmaM = 3.0;    ///< Of a coordinate about which a glimpse says nothing.

/// The glimpse along one axis of the body, relative to the predicted centre.
struct Shadow {
  double low_m = std::numeric_limits<double>::max();
  double high_m = std::numeric_limits<double>::lowest();
  bool low_is_end = false;     ///< The outermost point is the first or last and hidden beyond.
  bool high_is_end = false;
  double low_face_m = 0.0;     ///< Mean of the points on the outermost side.
  double high_face_m = 0.0;
  int low_count = 0;
  int high_count = 0;
};

struct AxisMeasurement {
  double centre_m = 0.0;
  double variance_m2 = kUnknownSigmaM * kUnknownSigmaM;
  double recentring_m = 0.0;
  Size size;
};

Shadow shadow_of(const Glimpse& glimpse, const Vector2d& centre_m, const Vector2d& axis) {
  Shadow shadow;
  const std::size_t count = glimpse.points_m.size();
  for (std::size_t i = 0; i < count; ++i) {
    const double s = axis.dot(glimpse.points_m[i] - centre_m);
    const bool is_hidden_end = (i == 0 && glimpse.occluded_at_start) || (i + 1 == count && glimpse.occluded_at_end);
    if (s < shadow.low_m) shadow.low_m = s, shadow.low_is_end = is_hidden_end;
    if (s > shadow.high_m) shadow.high_m = s, shadow.high_is_end = is_hidden_end;
  }
  for (const Vector2d& point : glimpse.points_m) {
    const double s = axis.dot(point - centre_m);
    if (s < shadow.low_m + kFaceDepthM) shadow.low_face_m += s, ++shadow.low_count;
    if (s > shadow.high_m - kFaceDepthM) shadow.high_face_m += s, ++shadow.high_count;
  }
  shadow.low_face_m /= shadow.low_count;
  shadow.high_face_m /= shadow.high_count;
  return shadow;
}

Shadow mirrored(const Shadow& shadow) {
  return {-shadow.high_m, -shadow.low_m, shadow.high_is_end, shadow.low_is_end,
          -shadow.high_face_m, -shadow.low_face_m, shadow.high_count, shadow.low_count};
}

/// A size is corrected by what was seen from edge to edge, and never below what was seen at all.
Size updated_size(const Size& size, double seen_m, bool both_edges_seen, double seen_variance_m2, double longest_m) {
  Size updated = size;
  if (both_edges_seen) {
    const double gain = size.variance_m2 / (size.variance_m2 + seen_variance_m2);
    updated.value_m += gain * (seen_m - size.value_m);
    updated.variance_m2 = std::max(1e-4, (1.0 - gain) * size.variance_m2);
  } else if (seen_m > size.value_m) {
    updated.value_m += 0.3 * (seen_m - size.value_m);
  }
  constexpr double kSmallestM = 0.4;
  updated.value_m = std::clamp(updated.value_m, kSmallestM, longest_m);
  return updated;
}

/// The laser lies beyond the low edge, which so looks at it. far_is_visible: the flank can be seen up to the far edge.
AxisMeasurement measure_from_low_side(const Size& size, const Shadow& shadow, bool far_is_visible, double edge_variance_m2,
                                      double far_variance_m2, double longest_m) {
  AxisMeasurement axis;
  const bool low_is_seen = !shadow.low_is_end || shadow.low_count >= 3;
  // Where the flank is not seen for what it should be, the far edge is not seen either.
  const bool high_is_seen = far_is_visible && !shadow.high_is_end && shadow.high_m - shadow.low_m > kLeastShareSeen * size.value_m;
  const double low_m = shadow.low_count >= 3 ? shadow.low_face_m : shadow.low_m;
  axis.size = updated_size(size, shadow.high_m - low_m, low_is_seen && high_is_seen, far_variance_m2, longest_m);
  const double half_m = 0.5 * axis.size.value_m;
  if (low_is_seen) {
    axis.centre_m = low_m + half_m;
    axis.variance_m2 = edge_variance_m2;
    axis.recentring_m = half_m - 0.5 * size.value_m;
  } else if (high_is_seen) {
    axis.centre_m = shadow.high_m - half_m;
    axis.variance_m2 = far_variance_m2;
    axis.recentring_m = 0.5 * size.value_m - half_m;
  }
  return axis;
}

/// The laser lies beside the body: both edges are outlines of the flank.
AxisMeasurement measure_from_beside(const Size& size, const Shadow& shadow, double edge_variance_m2, double longest_m) {
  AxisMeasurement axis;
  const bool is_whole = shadow.high_m - shadow.low_m > kLeastShareSeen * size.value_m;
  const bool low_is_seen = !shadow.low_is_end && (is_whole || shadow.high_is_end);
  const bool high_is_seen = !shadow.high_is_end && (is_whole || shadow.low_is_end);
  axis.size = updated_size(size, shadow.high_m - shadow.low_m, low_is_seen && high_is_seen, 2.0 * edge_variance_m2, longest_m);
  const double half_m = 0.5 * axis.size.value_m;
  if (low_is_seen && high_is_seen) {
    axis.centre_m = 0.5 * (shadow.low_m + shadow.high_m);
    axis.variance_m2 = 0.5 * edge_variance_m2;
  } else if (low_is_seen) {
    axis.centre_m = shadow.low_m + half_m;
    axis.variance_m2 = edge_variance_m2;
    axis.recentring_m = half_m - 0.5 * size.value_m;
  } else if (high_is_seen) {
    axis.centre_m = shadow.high_m - half_m;
    axis.variance_m2 = edge_variance_m2;
    axis.recentring_m = 0.5 * size.value_m - half_m;
  }
  return axis;
}

AxisMeasurement measure_axis(const Size& size, const Shadow& shadow, double laser_at_m, bool flank_is_visible,
                             double edge_variance_m2, double spacing_m, double longest_m) {
  const double spacing_variance_m2 = spacing_m * spacing_m / 3.0;  // the flank's end lies up to one spacing further
  const double outline_variance_m2 = edge_variance_m2 + spacing_variance_m2;
  if (std::abs(laser_at_m) <= 0.5 * size.value_m) return measure_from_beside(size, shadow, outline_variance_m2, longest_m);
  if (laser_at_m < 0.0)
    return measure_from_low_side(size, shadow, flank_is_visible, edge_variance_m2, outline_variance_m2, longest_m);
  AxisMeasurement axis =
      measure_from_low_side(size, mirrored(shadow), flank_is_visible, edge_variance_m2, outline_variance_m2, longest_m);
  axis.centre_m = -axis.centre_m;
  axis.recentring_m = -axis.recentring_m;
  return axis;
}

double echo_sigma_m(double range_m, const TrackingConfig& config) {
  return config.range_noise_m + config.range_noise_per_m * range_m;
}

}  // namespace

BodyMeasurement measure_box(const Body& body, const Vector2d& predicted_centre_m, const Glimpse& glimpse,
                            const TrackingConfig& config) {
  const Vector2d along{std::cos(body.heading_rad), std::sin(body.heading_rad)};
  const Vector2d across{-along.y(), along.x()};
  const Vector2d to_laser_m = glimpse.laser_m - predicted_centre_m;
  const double range_m = to_laser_m.norm();
  const double sight_along = std::abs(along.dot(to_laser_m)) / std::max(range_m, 1e-6);
  const double sight_across = std::abs(across.dot(to_laser_m)) / std::max(range_m, 1e-6);
  const double beam_width_m = range_m * glimpse.beam_step_rad;
  const double sigma_m = std::hypot(echo_sigma_m(range_m, config), config.shape_noise_m);
  constexpr double kLeastIncidence = 0.05;
  const bool flank_is_visible = std::abs(across.dot(to_laser_m)) > 0.5 * body.width.value_m + 0.3 &&
                                body.length.value_m * sight_across > kFewestBeams * beam_width_m;
  const bool face_is_visible = std::abs(along.dot(to_laser_m)) > 0.5 * body.length.value_m + 0.3 &&
                               body.width.value_m * sight_along > kFewestBeams * beam_width_m;
  const AxisMeasurement u = measure_axis(body.length, shadow_of(glimpse, predicted_centre_m, along), along.dot(to_laser_m), flank_is_visible,
                                         sigma_m * sigma_m, beam_width_m / std::max(sight_across, kLeastIncidence), config.longest_body_m);
  const AxisMeasurement v = measure_axis(body.width, shadow_of(glimpse, predicted_centre_m, across), across.dot(to_laser_m), face_is_visible,
                                         sigma_m * sigma_m, beam_width_m / std::max(sight_along, kLeastIncidence), 3.5);
  BodyMeasurement measurement;
  measurement.centre_m = predicted_centre_m + u.centre_m * along + v.centre_m * across;
  measurement.covariance_m2 = u.variance_m2 * along * along.transpose() + v.variance_m2 * across * across.transpose();
  measurement.recentring_m = u.recentring_m * along + v.recentring_m * across;
  measurement.body = body;
  measurement.body.length = u.size;
  measurement.body.width = v.size;
  return measurement;
}

BodyMeasurement measure_blob(const Body& body, const Glimpse& glimpse, const TrackingConfig& config) {
  BodyMeasurement measurement;
  Vector2d mean_m = Vector2d::Zero();
  for (const Vector2d& point : glimpse.points_m) mean_m += point;
  mean_m /= static_cast<double>(glimpse.points_m.size());
  const Vector2d sight_m = mean_m - glimpse.laser_m;
  const double range_m = std::max(sight_m.norm(), 1e-3);
  const Vector2d along = sight_m / range_m;
  const Vector2d across{-along.y(), along.x()};
  const double extent_m = extent_of(glimpse.points_m);
  constexpr double kSurfaceToMiddleM = 0.15;  // of a leg or a slim body
  const double sigma_along_m = std::hypot(echo_sigma_m(range_m, config), config.blob_noise_share * extent_m, config.shape_noise_m);
  const double sigma_across_m = std::hypot(range_m * glimpse.beam_step_rad / 3.5, config.blob_noise_share * extent_m, config.shape_noise_m);
  measurement.centre_m = mean_m + kSurfaceToMiddleM * along;
  measurement.covariance_m2 = sigma_along_m * sigma_along_m * along * along.transpose() +
                              sigma_across_m * sigma_across_m * across * across.transpose();
  measurement.body = body;
  const double grown_m = std::max(extent_m, body.length.value_m);
  measurement.body.length.value_m = body.length.value_m + 0.2 * (grown_m - body.length.value_m);
  measurement.body.width.value_m = measurement.body.length.value_m;
  return measurement;
}

Body likely_box(double heading_rad, double heading_variance_rad2, double seen_along_m, double seen_across_m) {
  Body body;
  body.has_sides = true;
  body.heading_rad = heading_rad;
  body.heading_variance_rad2 = heading_variance_rad2;
  // Means and one sigma of the kinds of road users; the side that is seen tells which is meant.
  if (seen_across_m > 2.2 || seen_along_m > 6.0) {
    body.length = {std::max(8.0, seen_along_m), 9.0};
    body.width = {2.4, 0.04};
  } else if (seen_across_m > 1.0 || seen_along_m > 2.2) {
    body.length = {4.4, 0.3};
    body.width = {1.8, 0.03};
  } else {
    body.length = {std::max(1.6, seen_along_m), 0.5};
    body.width = {0.7, 0.1};
  }
  body.length.value_m = std::max(body.length.value_m, seen_along_m);
  body.width.value_m = std::max(body.width.value_m, seen_across_m);
  return body;
}

double extent_of(std::span<const Vector2d> points_m) {
  double extent_m = 0.0;
  constexpr double kRootHalf = 0.70710678;
  for (const Vector2d& axis : {Vector2d(1.0, 0.0), Vector2d(0.0, 1.0), Vector2d(kRootHalf, kRootHalf), Vector2d(kRootHalf, -kRootHalf)}) {
    double low = std::numeric_limits<double>::max();
    double high = std::numeric_limits<double>::lowest();
    for (const Vector2d& point : points_m) {
      const double s = axis.dot(point);
      low = std::min(low, s), high = std::max(high, s);
    }
    extent_m = std::max(extent_m, high - low);
  }
  return extent_m;
}

Vector2d offset_from_box(const Body& body, const Vector2d& centre_m, double margin_m, const Vector2d& point_m) {
  const double c = std::cos(body.heading_rad);
  const double s = std::sin(body.heading_rad);
  const Vector2d d = point_m - centre_m;
  const auto beyond = [](double value, double half) { return std::copysign(std::max(0.0, std::abs(value) - half), value); };
  const double u = beyond(c * d.x() + s * d.y(), 0.5 * body.length.value_m + margin_m);
  const double v = beyond(-s * d.x() + c * d.y(), 0.5 * body.width.value_m + margin_m);
  return {c * u - s * v, s * u + c * v};
}

}  // namespace slammot::tracking
