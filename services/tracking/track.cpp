#include "services/tracking/track.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "common/geometry/pose2.hpp"

namespace slammot::tracking {
namespace {

using Eigen::Matrix2d;
using Eigen::Vector2d;
using geometry::wrap_angle;

constexpr double kHeadingDriftRad2PerS = 0.1;  ///< How fast a body may turn, as a random walk.

/// Heading at which the velocity and its covariance point, and how surely.
struct Course {
  double heading_rad = 0.0;
  double variance_rad2 = 10.0;
};

Course course_of(const Track& track) {
  const Vector2d velocity = track.velocity_mps();
  const double speed2 = std::max(velocity.squaredNorm(), 1e-6);
  const Vector2d across{-velocity.y(), velocity.x()};
  return {std::atan2(velocity.y(), velocity.x()), across.dot(track.velocity_covariance() * across) / (speed2 * speed2)};
}

/// Brings the body's heading to the course. A body that goes backwards or sideways was drawn the wrong way round.
void follow_course(Track& track, const TrackingConfig& config) {
  if (track.velocity_mps().norm() < config.box_from_speed_mps) return;
  const Course course = course_of(track);
  if (course.variance_rad2 > 0.1) return;
  Body& body = track.body;
  double off_rad = wrap_angle(course.heading_rad - body.heading_rad);
  if (std::abs(off_rad) > 0.75 * std::numbers::pi) {
    body.heading_rad = wrap_angle(body.heading_rad + std::numbers::pi);
    off_rad = wrap_angle(off_rad + std::numbers::pi);
  } else if (std::abs(off_rad) > 0.25 * std::numbers::pi && course.variance_rad2 < 0.03) {
    body.heading_rad = wrap_angle(body.heading_rad + std::copysign(0.5 * std::numbers::pi, off_rad));
    body.heading_variance_rad2 = 0.3;
    std::swap(body.length, body.width);
    body.width.value_m = std::min(body.width.value_m, 2.6);
    body.length.variance_m2 = std::max(body.length.variance_m2, 1.0);
    off_rad = wrap_angle(course.heading_rad - body.heading_rad);
  }
  const double variance_rad2 = course.variance_rad2 + 0.002;  // wheels do not always roll where the body points
  const double gain = body.heading_variance_rad2 / (body.heading_variance_rad2 + variance_rad2);
  body.heading_rad = wrap_angle(body.heading_rad + gain * off_rad);
  body.heading_variance_rad2 *= 1.0 - gain;
}

struct Spans {
  double along_m = 0.0;
  double across_m = 0.0;
};

Spans spans_of(const Glimpse& glimpse, double heading_rad) {
  const Vector2d along{std::cos(heading_rad), std::sin(heading_rad)};
  const Vector2d across{-along.y(), along.x()};
  double low_u = 1e9, high_u = -1e9, low_v = 1e9, high_v = -1e9;
  for (const Vector2d& point : glimpse.points_m) {
    low_u = std::min(low_u, along.dot(point)), high_u = std::max(high_u, along.dot(point));
    low_v = std::min(low_v, across.dot(point)), high_v = std::max(high_v, across.dot(point));
  }
  return {high_u - low_u, high_v - low_v};
}

/// Gives sides to a blob that has become large and whose course is known, without a jump: the echoes stay where they are.
void draw_sides_when_known(Track& track, const Glimpse& glimpse, const TrackingConfig& config) {
  const bool is_large = track.largest_extent_m > config.box_from_extent_m;
  if (track.body.has_sides || !is_large || track.velocity_mps().norm() < config.box_from_speed_mps) return;
  const Course course = course_of(track);
  if (course.variance_rad2 > 0.05) return;
  const Spans spans = spans_of(glimpse, course.heading_rad);
  const BodyMeasurement as_blob = measure_blob(track.body, glimpse, config);
  track.body = likely_box(course.heading_rad, course.variance_rad2, spans.along_m, spans.across_m);
  const BodyMeasurement as_box = measure_box(track.body, as_blob.centre_m, glimpse, config);
  track.body = as_box.body;
  const filters::ModelSet models = motion_models(config);
  filters::imm_shift(models, track.motion, as_box.centre_m - as_blob.centre_m);
  track.birth_position_m += as_box.centre_m - as_blob.centre_m;
  track.estimate = filters::imm_combine(models, track.motion);
}

void update_motion_state(Track& track, const TrackingConfig& config) {
  const double speed = track.velocity_mps().norm();
  if (track.confirmed) track.fastest_mps = std::max(track.fastest_mps, speed);
  if (speed < config.stopped_below_mps) track.state = flow::Motion::kStopped;
  if (speed > config.moving_above_mps) track.state = flow::Motion::kMoving;
}

void remember_contour(Track& track, const Glimpse& glimpse) {
  constexpr std::size_t kMostPoints = 64;
  const std::size_t stride = 1 + (glimpse.points_m.size() - 1) / kMostPoints;
  track.contour_in_odom_m.clear();
  for (std::size_t i = 0; i < glimpse.points_m.size(); i += stride)
    track.contour_in_odom_m.push_back(glimpse.points_m[i].cast<float>());
}

std::vector<flow::PredictedPosition> predicted_path(const Track& track, const TrackingConfig& config) {
  constexpr int kSteps = 6;
  constexpr double kStepS = 0.5;
  const filters::ModelSet models = motion_models(config);
  const filters::MotionModel cruise = models.models[0];
  std::vector<flow::PredictedPosition> path;
  for (int step = 1; step <= kSteps; ++step) {
    const filters::MotionState there = filters::predict(cruise, track.estimate, step * kStepS);
    path.push_back({step * kStepS, there.mean.head<2>(), there.covariance.topLeftCorner<2, 2>()});
  }
  return path;
}

void observe(Track& track, std::int64_t stamp_ns, const Glimpse& glimpse) {
  ++track.hits;
  track.last_seen_ns = stamp_ns;
  track.largest_extent_m = std::max(track.largest_extent_m, extent_of(glimpse.points_m));
  remember_contour(track, glimpse);
}

}  // namespace

filters::ModelSet motion_models(const TrackingConfig& config) {
  filters::ModelSet set;
  set.models[0] = {filters::MotionKind::kConstantVelocity, config.velocity_noise_density, config.idle_acceleration_mps2};
  set.models[1] = {filters::MotionKind::kConstantAcceleration, config.jerk_noise_density, 0.0};
  set.size = 2;
  set.mean_stay_s = config.mean_stay_s;
  return set;
}

Track begun(flow::TrackId track_id, std::int64_t stamp_ns, const Glimpse& glimpse, const Matrix2d& pose_covariance_m2,
            const TrackingConfig& config) {
  Track track;
  track.track_id = track_id;
  track.first_seen_ns = stamp_ns;
  track.score = config.birth_score;
  const double extent_m = std::max(0.4, extent_of(glimpse.points_m));
  track.body.length = {extent_m, 1.0};
  track.body.width = {extent_m, 1.0};
  const BodyMeasurement blob = measure_blob(track.body, glimpse, config);
  filters::MotionState start;
  start.mean.head<2>() = blob.centre_m;
  start.covariance.topLeftCorner<2, 2>() = blob.covariance_m2 + pose_covariance_m2;
  start.covariance.block<2, 2>(2, 2) = 0.25 * config.fastest_mps * config.fastest_mps * Matrix2d::Identity();
  start.covariance.block<2, 2>(4, 4) = config.idle_acceleration_mps2 * config.idle_acceleration_mps2 * Matrix2d::Identity();
  track.motion = filters::imm_start(motion_models(config), start);
  track.estimate = start;
  track.birth_position_m = blob.centre_m;
  track.birth_covariance_m2 = blob.covariance_m2;
  observe(track, stamp_ns, glimpse);
  return track;
}

void predict(Track& track, double time_s, const TrackingConfig& config) {
  const filters::ModelSet models = motion_models(config);
  track.motion = filters::imm_predict(models, track.motion, time_s);
  track.estimate = filters::imm_combine(models, track.motion);
  track.body.heading_variance_rad2 = std::min(10.0, track.body.heading_variance_rad2 + kHeadingDriftRad2PerS * time_s);
}

void update(Track& track, std::int64_t stamp_ns, const Glimpse& glimpse, const Matrix2d& pose_covariance_m2, const TrackingConfig& config) {
  const filters::ModelSet models = motion_models(config);
  const BodyMeasurement measurement = track.body.has_sides ? measure_box(track.body, track.position_m(), glimpse, config)
                                                           : measure_blob(track.body, glimpse, config);
  filters::imm_shift(models, track.motion, measurement.recentring_m);
  track.birth_position_m += measurement.recentring_m;
  track.body = measurement.body;
  track.motion = filters::imm_update(models, track.motion, measurement.centre_m, measurement.covariance_m2 + pose_covariance_m2).posterior;
  track.estimate = filters::imm_combine(models, track.motion);
  observe(track, stamp_ns, glimpse);
  if (track.body.has_sides) follow_course(track, config);
  else draw_sides_when_known(track, glimpse, config);
  update_motion_state(track, config);
  track.object_class = likely_class(track);
}

void score_hit(Track& track, flow::PointLabel label, const TrackingConfig& config) {
  const bool is_moving = label == flow::PointLabel::kMoving;
  track.moving_hits += is_moving ? 1 : 0;
  track.farthest_m = std::max(track.farthest_m, (track.position_m() - track.birth_position_m).norm());
  double gain = is_moving ? config.moving_hit_score : config.other_hit_score;
  const bool is_trusted = track.farthest_m >= config.travel_to_trust_m && track.moving_hits >= config.moving_hits_to_trust;
  if (!is_moving && !is_trusted) gain = config.idle_score;
  if (label == flow::PointLabel::kStationary && track.velocity_mps().norm() > 1.5) gain = config.contradiction_score;
  track.score = std::min(config.most_score, track.score + gain);
}

void score_miss(Track& track, const Visibility& visibility, double time_s, const TrackingConfig& config) {
  track.score += (visibility.beams == 0 ? config.out_of_view_score_per_s : config.occluded_score_per_s) * time_s;
  // What hides the body before and behind counts less: a share of the beams decides how sure the miss is.
  const double share = visibility.beams == 0 ? 0.0 : static_cast<double>(visibility.passed) / visibility.beams;
  track.score += std::max(config.most_passed_score, config.passed_beam_score * visibility.passed) * share;
}

bool has_proven_to_move(const Track& track, const TrackingConfig& config) {
  const Vector2d travel_m = track.position_m() - track.birth_position_m;
  const double distance_m = travel_m.norm();
  const Vector2d way = travel_m / std::max(distance_m, 1e-6);
  const double sigma_m = std::sqrt(way.dot((track.position_covariance_m2() + track.birth_covariance_m2) * way));
  const double least_travel_m = config.least_travel_m + config.least_travel_per_extent * track.largest_extent_m;
  return track.hits >= config.least_hits && track.score >= config.confirm_score && distance_m >= least_travel_m &&
         track.moving_hits >= config.least_moving_share * track.hits &&
         distance_m >= config.least_travel_sigmas * sigma_m;
}

flow::ObjectClass likely_class(const Track& track) {
  const double length_m = track.body.length.value_m;
  if (!track.body.has_sides) {
    const double fastest_mps = std::max(track.fastest_mps, track.velocity_mps().norm());
    if (track.largest_extent_m < 1.0) return fastest_mps < 2.7 ? flow::ObjectClass::kPedestrian : flow::ObjectClass::kBicycle;
    return flow::ObjectClass::kUnknown;
  }
  if (length_m > 6.0) return flow::ObjectClass::kTruckOrBus;
  if (length_m < 2.4 && track.body.width.value_m < 1.3) return flow::ObjectClass::kBicycle;
  return flow::ObjectClass::kCar;
}

flow::TrackedObject described(const Track& track, std::int64_t stamp_ns, const TrackingConfig& config) {
  flow::TrackedObject object;
  object.track_id = track.track_id;
  const double unseen_s = static_cast<double>(stamp_ns - track.last_seen_ns) * 1e-9;
  object.confirmed = track.confirmed && track.score >= config.publish_score && unseen_s <= config.longest_unseen_published_s;
  object.existence = existence_of(track.score);
  object.position_in_odom_m = track.position_m();
  object.velocity_in_odom_mps = track.velocity_mps();
  object.covariance = track.estimate.covariance.topLeftCorner<4, 4>();
  object.acceleration_in_odom_mps2 = track.estimate.mean.segment<2>(4);
  object.heading_in_odom_rad = track.body.has_sides ? track.body.heading_rad : course_of(track).heading_rad;
  object.length_m = track.body.length.value_m;
  object.width_m = track.body.width.value_m;
  object.motion = track.state;
  object.object_class = track.object_class;
  object.mode_probability = track.motion.probability;
  object.first_seen_ns = track.first_seen_ns;
  object.last_seen_ns = track.last_seen_ns;
  object.contour_in_odom_m = track.contour_in_odom_m;
  if (track.confirmed) object.predicted_path = predicted_path(track, config);
  // The filter follows a centre that assumes the size; what is not known of the size is added here.
  const Vector2d along{std::cos(object.heading_in_odom_rad), std::sin(object.heading_in_odom_rad)};
  if (track.body.has_sides)
    object.covariance.topLeftCorner<2, 2>() += 0.25 * track.body.length.variance_m2 * along * along.transpose();
  return object;
}

Track resumed(const flow::TrackedObject& object, const TrackingConfig& config) {
  Track track;
  track.track_id = object.track_id;
  track.confirmed = object.confirmed;
  track.score = std::log(std::max(object.existence, 1e-6) / std::max(1.0 - object.existence, 1e-6));
  track.score = std::min(track.score, config.most_score);
  track.state = object.motion;
  track.object_class = object.object_class;
  track.first_seen_ns = object.first_seen_ns;
  track.last_seen_ns = object.last_seen_ns;
  track.hits = config.least_hits;
  track.largest_extent_m = object.length_m;
  track.body.has_sides = object.length_m > config.box_from_extent_m;
  track.body.heading_rad = object.heading_in_odom_rad;
  track.body.heading_variance_rad2 = 0.05;
  track.body.length = {object.length_m, 0.3};
  track.body.width = {object.width_m, 0.05};
  filters::MotionState start;
  start.mean << object.position_in_odom_m, object.velocity_in_odom_mps, object.acceleration_in_odom_mps2;
  start.covariance.topLeftCorner<4, 4>() = object.covariance;
  start.covariance.block<2, 2>(4, 4) = config.idle_acceleration_mps2 * config.idle_acceleration_mps2 * Matrix2d::Identity();
  track.motion = filters::imm_start(motion_models(config), start);
  track.estimate = start;
  track.birth_position_m = object.position_in_odom_m;
  return track;
}

double existence_of(double score) { return 1.0 / (1.0 + std::exp(-score)); }

}  // namespace slammot::tracking
