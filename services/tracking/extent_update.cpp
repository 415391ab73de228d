#include "services/tracking/extent_update.hpp"

#include <algorithm>
#include <cmath>

#include "common/geometry/pose2.hpp"
#include "services/tracking/confirmation.hpp"

namespace slammot::tracking {

using Eigen::Vector2d;

void redraw(Track& track, const Box& box, const Observation& observation,
            const TrackingConfig& config) {
  const Vector2d before_m =
      seen_centre_m(track.extent.outline, track.position_m(), observation, config);
  const BoxMeasurement after =
      measure_box(box, supposed_centre_m(box, observation), observation, config);
  track.extent.outline = after.box;
  shift(track, after.centre_m - before_m, config);
  combine(track.kinematics, config);
}

void turn(Track& track, double by_rad, const Observation& observation,
          const TrackingConfig& config) {
  Box& box = *track.extent.box();
  const Vector2d before_m = box_centre_m(box, track.position_m(), observation, config);
  box.heading_rad = geometry::wrap_angle(box.heading_rad + by_rad);
  const Vector2d shift_m = box_centre_m(box, track.position_m(), observation, config) - before_m;
  shift(track, shift_m, config);
  combine(track.kinematics, config);
}

Box box_along_course(const Track& track, const Observation& observation,
                     const TrackingConfig& config) {
  const RoadUsers& road_users = *track.footprint().road_users;
  const Vector2d way = observation.points_m.back() - observation.points_m.front();
  Box box = likely_box(std::atan2(way.y(), way.x()), observation, config, road_users);
  const Course course = course_of(track.kinematics);
  if (track.velocity_mps().norm() > config.extent.box_from_speed_mps &&
      course.variance_rad2 < 0.05) {
    box = likely_box(course.heading_rad, observation, config, road_users);
    if (std::abs(std::cos(box.heading_rad - course.heading_rad)) < 0.7)
      box = turned_by_a_quarter(box, 1.0, config);
    box.heading_rad = course.heading_rad;
    box.heading_variance_rad2 = course.variance_rad2;
  }
  return box;
}

void become_box_if_large(Track& track, const Observation& observation,
                         const TrackingConfig& config) {
  if (track.extent.box() != nullptr ||
      track.extent.largest_span_m < config.extent.box_from_extent_m || is_known_pedestrian(track))
    return;
  redraw(track, box_along_course(track, observation, config), observation, config);
}

void exchange_sides_if_likelier(Track& track, const Observation& observation,
                                const TrackingConfig& config) {
  constexpr double kWidestCarM = 2.1;
  const Box& box = *track.extent.box();
  if (box.is_oriented || box.evidence.width.least_m < kWidestCarM * config.extent.size_scale)
    return;
  const Box turned = turned_by_a_quarter(box, 1.0, config);
  if (!is_plausible(turned, config) ||
      log_evidence_of_sizes(turned, config) - log_evidence_of_sizes(box, config) < kSureOdds)
    return;
  redraw(track, turned, observation, config);
}

void reinitialise_extent(Track& track, const Observation& observation,
                         const TrackingConfig& config) {
  const Box box = box_along_course(track, observation, config);
  const BoxMeasurement drawn =
      measure_box(box, supposed_centre_m(box, observation), observation, config);
  track.extent.outline = drawn.box;
  shift(track, drawn.centre_m - track.position_m(), config);
  combine(track.kinematics, config);
  track.extent.largest_span_m =
      std::max(track.extent.largest_span_m, largest_span_m(observation.points_m));
}

void reinitialise_extent_if_misfit(Track& track, const Observation& observation, double time_s,
                                   const TrackingConfig& config) {
  constexpr double kAfterS = 0.15;
  constexpr std::size_t kFewestEchoes = 5;
  double& misfit_s = track.extent.misfit.off_sides_s;
  misfit_s = misfits_only(track, config) ? misfit_s + time_s : 0.0;
  if (misfit_s <= kAfterS || observation.points_m.size() < kFewestEchoes) return;
  reinitialise_extent(track, observation, config);
  misfit_s = 0.0;
}

}  // namespace slammot::tracking
