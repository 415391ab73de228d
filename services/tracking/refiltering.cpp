#include "services/tracking/refiltering.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "common/filters/imm.hpp"
#include "common/filters/move_stop.hpp"
#include "common/geometry/pose2.hpp"

namespace slammot::tracking {
namespace {

using Eigen::Matrix2d;
using Eigen::Vector2d;

/// With what is known by now of how seldom the thing answers.
Observation observation_of(const StoredObservation& kept, const Track& track) {
  Observation observation = kept.with_points();
  observation.unanswered_share = track.responses.unanswered_share();
  return observation;
}

filters::MotionState beginning_of(const Track& track, const Body& body, const TrackingConfig& config) {
  const StoredObservation& kept = track.observations[0];
  const Observation observation = observation_of(kept, track);
  const BodyMeasurement measured = measure_box(body, supposed_centre_m(body, observation), observation, config);
  filters::MotionState start;
  start.mean.head<2>() = measured.centre_m - measured.recentring_m;
  start.covariance.topLeftCorner<2, 2>() = measured.covariance_m2 + kept.pose_covariance_m2;
  start.covariance.block<2, 2>(2, 2) = std::pow(0.5 * config.fastest_mps, 2) * Matrix2d::Identity();
  start.covariance.block<2, 2>(4, 4) = std::pow(config.idle_acceleration_mps2, 2) * Matrix2d::Identity();
  return start;
}

/// A body of just this size and heading all the time.
Belief belief_with(const Track& track, Body body, const TrackingConfig& config) {
  const filters::ModelSet models = motion_models(config);
  filters::ImmState motion = filters::imm_start(models, beginning_of(track, body, config));
  body.length_held.reset();
  body.width_held.reset();
  for (std::size_t i = 1; i < track.observations.size(); ++i) {
    const StoredObservation& kept = track.observations[i];
    motion = filters::imm_predict(models, motion, static_cast<double>(kept.stamp_ns - track.observations[i - 1].stamp_ns) * 1e-9);
    const Vector2d predicted_m = filters::imm_combine(models, motion).mean.head<2>();
    const BodyMeasurement measured = measure_box(body, predicted_m, observation_of(kept, track), config);
    filters::imm_loosen(models, motion, measured.step_covariance_m2);
    body.length_held = measured.body.length_held;
    body.width_held = measured.body.width_held;
    motion = filters::imm_update(models, motion, measured.centre_m - measured.recentring_m, measured.covariance_m2 + kept.pose_covariance_m2).posterior;
  }
  return {body, motion, filters::imm_combine(models, motion), {}};
}

/// That the body goes along its length, at any speed.
double log_likelihood_of_course(const Belief& belief, const TrackingConfig& config) {
  const Vector2d velocity_mps = belief.estimate.mean.segment<2>(2);
  const Matrix2d P = belief.estimate.covariance.block<2, 2>(2, 2);
  const Vector2d along{std::cos(belief.body.heading_rad), std::sin(belief.body.heading_rad)};
  const Vector2d across{-along.y(), along.x()};
  const auto log_density = [&](const Vector2d& axis, double variance) {
    const double S = axis.dot(P * axis) + variance;
    return -0.5 * std::pow(axis.dot(velocity_mps), 2) / S - 0.5 * std::log(S);
  };
  return log_density(along, std::pow(0.5 * config.fastest_mps, 2)) +
         log_density(across, std::pow(kSlipMps * config.size_scale, 2) + kSlip * kSlip * velocity_mps.squaredNorm());
}

double log_likelihood(const Belief& belief, const TrackingConfig& config) {
  return log_likelihood_of_course(belief, config) + log_evidence_of_sizes(belief.body, config);
}

Body along_its_sides(Body body) {
  if (body.axis_variance_rad2 < kKnownAxisRad2) body.heading_rad += std::remainder(body.axis_rad - body.heading_rad, 0.5 * std::numbers::pi);
  body.heading_rad = geometry::wrap_angle(body.heading_rad);
  return body;
}

}  // namespace

Belief belief(const Track& track) { return {track.body, track.motion, track.estimate, track.consistency}; }

Belief refiltered(const Track& track, const TrackingConfig& config) {
  if (!track.body.has_sides || track.observations.size() < 2) return belief(track);
  Belief belief = belief_with(track, along_its_sides(track.body), config);
  const Body turned = turned_by_a_quarter(belief.body, 1.0, config);
  if (is_plausible(turned, config)) {
    const Belief other = belief_with(track, turned, config);
    const double odds = log_likelihood(other, config) - log_likelihood(belief, config);
    if (odds > 0.0) belief = other;
    belief.body.is_oriented = std::abs(odds) > kSureOdds;
  }
  return belief;
}

void set_belief(Track& track, const Belief& belief) {
  const Vector2d by_m = belief.estimate.mean.head<2>() - track.position_m();
  track.body = belief.body;
  track.motion = belief.motion;
  track.estimate = belief.estimate;
  track.consistency = belief.consistency;
  track.may_turn = false;
  track.cruises_only = false;
  track.birth_position_m += by_m;
  track.anchor_m += by_m;
  filters::move_stop_shift(track.move_stop, by_m);
}

}  // namespace slammot::tracking
