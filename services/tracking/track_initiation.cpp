#include "services/tracking/track_initiation.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "services/tracking/evidence_limits.hpp"
#include "services/tracking/measurement_update.hpp"

namespace slammot::tracking {
namespace {

using Eigen::Matrix2d;

/// An empty track that keeps the memory of the old one.
void clear(Track& track) {
  Track empty;
  empty.extent.contour_in_odom_m = std::move(track.extent.contour_in_odom_m);
  empty.extent.contour_in_odom_m.clear();
  empty.history = emptied(std::move(track.history));
  track = std::move(empty);
}

OutlineMeasurement first_outline(const FirstObservation& first, const TrackingConfig& config,
                                 const RoadUsers& road_users) {
  const double span_m = std::max(0.4, largest_span_m(first.observation.points_m));
  if (span_m > config.extent.box_from_extent_m) {
    const Box box = likely_box(first.box_heading_rad, first.observation, config, road_users);
    return measure(box, supposed_centre_m(box, first.observation), first.observation, config);
  }
  Blob blob;
  blob.road_users = &road_users;
  blob.length = {span_m, 1.0};
  blob.width = {span_m, 1.0};
  return measure(blob, Eigen::Vector2d::Zero(), first.observation, config);
}

filters::MotionState state_at_rest(const OutlineMeasurement& measurement,
                                   const Matrix2d& pose_covariance_m2,
                                   const TrackingConfig& config) {
  filters::MotionState state;
  state.mean.head<2>() = measurement.centre_m;
  state.covariance.topLeftCorner<2, 2>() = measurement.covariance_m2 + pose_covariance_m2;
  const double sigma_mps = (is_box(measurement.outline) ? 0.5 : 0.2) * config.motion.fastest_mps;
  state.covariance.block<2, 2>(2, 2) = sigma_mps * sigma_mps * Matrix2d::Identity();
  state.covariance.block<2, 2>(4, 4) =
      kIdleAccelerationMps2 * kIdleAccelerationMps2 * Matrix2d::Identity();
  return state;
}

Outline outline_from_message(const flow::TrackedObject& object, const TrackingConfig& config) {
  if (object.length_m <= config.extent.box_from_extent_m) {
    Blob blob;
    blob.heading_rad = object.heading_in_odom_rad;
    blob.length = {object.length_m, 0.3};
    blob.width = {object.width_m, 0.05};
    return blob;
  }
  Box box;
  box.heading_rad = object.heading_in_odom_rad;
  box.heading_variance_rad2 = 0.05;
  box.is_oriented = true;
  box.evidence.length.whole = {object.length_m, 0.3};
  box.evidence.width.whole = {object.width_m, 0.05};
  return with_likely_sizes(box, config);
}

double score_from(double existence, const TrackingConfig& config) {
  const double score = std::log(std::max(existence, 1e-6) / std::max(1.0 - existence, 1e-6));
  return std::min(score, evidence_limits(config).most_score);
}

}  // namespace

void initiate(Track& track, const FirstObservation& first, const TrackingConfig& config,
              const RoadUsers& road_users) {
  clear(track);
  track.track_id = track.object_id = first.track_id;
  track.history.first_seen_ns = first.stamp_ns;
  track.existence.score = kBirthScore;
  const OutlineMeasurement measurement = first_outline(first, config, road_users);
  track.extent.outline = measurement.outline;
  restart_from(track.kinematics, state_at_rest(measurement, first.pose_covariance_m2, config),
               config);
  track.history.birth = {measurement.centre_m, measurement.covariance_m2};
  track.existence.travel.anchor_m = measurement.centre_m;
  note_observation(track, first.stamp_ns, first.observation);
}

Track initiated(const FirstObservation& first, const TrackingConfig& config,
                const RoadUsers& road_users) {
  Track track;
  initiate(track, first, config, road_users);
  return track;
}

Track track_from_message(const flow::TrackedObject& object, const TrackingConfig& config) {
  Track track;
  track.track_id = track.object_id = object.track_id;
  track.extent.outline = outline_from_message(object, config);
  track.extent.largest_span_m = object.length_m;
  track.existence.confirmed = object.confirmed;
  track.existence.score = score_from(object.existence, config);
  track.existence.hits = evidence_limits(config).least_hits;
  track.existence.travel.travelled_m = config.existence.least_travel_to_stand_m;
  track.existence.travel.anchor_m = object.position_in_odom_m;
  track.existence.travel.last_moving_ns = object.last_seen_ns;
  track.classification.likeliest = object.object_class;
  track.classification.probability = object.class_probability;
  track.history.first_seen_ns = object.first_seen_ns;
  track.history.last_seen_ns = object.last_seen_ns;
  if (object.confirmed) track.history.first_published_ns = object.first_seen_ns;
  track.history.birth.centre_m = object.position_in_odom_m;
  filters::MotionState start;
  start.mean << object.position_in_odom_m, object.velocity_in_odom_mps,
      object.acceleration_in_odom_mps2;
  start.covariance.topLeftCorner<4, 4>() = object.covariance;
  start.covariance.block<2, 2>(4, 4) =
      kIdleAccelerationMps2 * kIdleAccelerationMps2 * Matrix2d::Identity();
  restart_from(track.kinematics, start, config);
  track.kinematics.state = object.motion;
  return track;
}

}  // namespace slammot::tracking
