#include "services/tracking/box_measurement.hpp"

#include <cmath>

#include "services/tracking/axis_measurement.hpp"
#include "services/tracking/box_corner.hpp"

namespace slammot::tracking {
namespace {

using Eigen::Matrix2d;
using Eigen::Vector2d;

/// An observation along both axes of a box, and which of its sides the laser sees.
struct BoxProjection {
  Vector2d along = Vector2d::UnitX();
  Vector2d across = Vector2d::UnitY();
  Projection u;
  Projection v;
  AxisView u_view;
  AxisView v_view;
  bool is_flank_visible = false;
  bool is_face_visible = false;
};

/// Points this near the outermost one lie on the same side.
double face_depth_m(double sigma_m, const TrackingConfig& config) {
  constexpr double kFaceDepthM = 0.15;
  constexpr double kFaceDepthSigmas = 3.0;
  return kFaceDepthM * config.extent.size_scale + kFaceDepthSigmas * sigma_m;
}

BoxProjection box_projection_of(const Box& box, const Vector2d& predicted_centre_m,
                                const Observation& observation, const TrackingConfig& config) {
  BoxProjection seen;
  seen.along = {std::cos(box.heading_rad), std::sin(box.heading_rad)};
  seen.across = {-seen.along.y(), seen.along.x()};
  const Vector2d to_laser_m = observation.laser_m - predicted_centre_m;
  const double sigma_m =
      std::hypot(echo_sigma_m(to_laser_m.norm(), config), config.sensor.shape_noise_m);
  seen.u =
      projection_of(observation, predicted_centre_m, seen.along, face_depth_m(sigma_m, config));
  seen.v =
      projection_of(observation, predicted_centre_m, seen.across, face_depth_m(sigma_m, config));
  const double gap = mean_gap(observation);
  const Size corner = corner_of(box, box.kind, config);
  const auto view_of = [&](const Vector2d& axis, const Projection& projection) {
    return AxisView{axis.dot(to_laser_m),
                    sigma_m * sigma_m,
                    end_view(observation, predicted_centre_m + projection.low_m * axis, axis),
                    end_view(observation, predicted_centre_m + projection.high_m * axis, axis),
                    gap,
                    0.4 * config.extent.size_scale,
                    0.5 * config.extent.size_scale,
                    config.extent.size_scale,
                    true,
                    corner};
  };
  seen.u_view = view_of(seen.along, seen.u);
  seen.v_view = view_of(seen.across, seen.v);
  seen.v_view.is_length = false;
  const double clear_m = 0.3 * config.extent.size_scale;
  seen.is_flank_visible = std::abs(seen.v_view.laser_at_m) > 0.5 * box.width.value_m + clear_m;
  seen.is_face_visible = std::abs(seen.u_view.laser_at_m) > 0.5 * box.length.value_m + clear_m;
  return seen;
}

Size corner_after(const Box& box, const Vector2d& predicted_centre_m,
                  const Observation& observation, const BoxProjection& seen) {
  const std::optional<NearSide> u = near_side(box.length, seen.u, seen.u_view);
  const std::optional<NearSide> v = near_side(box.width, seen.v, seen.v_view);
  if (!u || !v) return box.corner_seen;
  const std::optional<Size> corner = seen_corner(
      observation, predicted_centre_m, {seen.along, seen.across, seen.u_view, seen.v_view, *u, *v});
  return corner ? with_corner(box.corner_seen, *corner, seen.u_view.scale) : box.corner_seen;
}

SizesSeen evidence_after(const Box& box, const BoxProjection& seen) {
  SizesSeen evidence = box.evidence;
  add_sizes(evidence.length, box.length, seen.u, seen.u_view, seen.is_flank_visible);
  add_sizes(evidence.width, box.width, seen.v, seen.v_view, seen.is_face_visible);
  if (!box.is_oriented) {  // the lower bounds only: which size is which is unknown
    evidence.length.whole = box.evidence.length.whole;
    evidence.length.missed_share = box.evidence.length.missed_share;
    evidence.width.whole = box.evidence.width.whole;
    evidence.width.missed_share = box.evidence.width.missed_share;
  }
  return evidence;
}

}  // namespace

BoxMeasurement measure_box(const Box& box, const Vector2d& predicted_centre_m,
                           const Observation& observation, const TrackingConfig& config) {
  const BoxProjection seen = box_projection_of(box, predicted_centre_m, observation, config);
  const Vector2d& along = seen.along;
  const Vector2d& across = seen.across;
  BoxMeasurement measurement;
  Box& after = measurement.box;
  after = box;
  after.corner_seen = corner_after(box, predicted_centre_m, observation, seen);
  after.evidence = evidence_after(box, seen);
  after = with_likely_sizes(after, config);
  const AxisMeasurement at_u =
      measure_axis(after.length, seen.u, seen.u_view, seen.is_flank_visible);
  const AxisMeasurement at_v = measure_axis(after.width, seen.v, seen.v_view, seen.is_face_visible);
  measurement.centre_m = predicted_centre_m + at_u.centre_m * along + at_v.centre_m * across;
  measurement.covariance_m2 =
      at_u.variance_m2 * along * along.transpose() + at_v.variance_m2 * across * across.transpose();
  const double longer_m = after.length.value_m - box.length.value_m;
  const double wider_m = after.width.value_m - box.width.value_m;
  measurement.recentring_m = -0.5 * at_u.anchor.value_or(0) * longer_m * along -
                             0.5 * at_v.anchor.value_or(0) * wider_m * across;
  measurement.step_covariance_m2 =
      step_variance_m2(box.anchors.length, at_u.anchor, after.length) * along * along.transpose() +
      step_variance_m2(box.anchors.width, at_v.anchor, after.width) * across * across.transpose();
  if (at_u.anchor) after.anchors.length = at_u.anchor;
  if (at_v.anchor) after.anchors.width = at_v.anchor;
  return measurement;
}

Vector2d box_centre_m(const Box& box, const Vector2d& predicted_centre_m,
                      const Observation& observation, const TrackingConfig& config) {
  const BoxProjection seen = box_projection_of(box, predicted_centre_m, observation, config);
  return predicted_centre_m +
         measure_axis(box.length, seen.u, seen.u_view, seen.is_flank_visible).centre_m *
             seen.along +
         measure_axis(box.width, seen.v, seen.v_view, seen.is_face_visible).centre_m * seen.across;
}

}  // namespace slammot::tracking
