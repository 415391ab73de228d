#include "services/tracking/refiltering.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "common/filters/move_stop.hpp"
#include "common/geometry/pose2.hpp"

namespace slammot::tracking {
namespace {

using Eigen::Matrix2d;
using Eigen::Vector2d;

/// With the response rate as known now.
Observation observation_of(const StoredObservation& stored, const Track& track) {
  Observation observation = stored.with_points();
  observation.unanswered_share = track.extent.responses.unanswered_share();
  return observation;
}

/// At rest at the first stored observation.
filters::MotionState first_state(const Track& track, const Box& box, const TrackingConfig& config) {
  const StoredObservation& stored = track.history.observations[0];
  const Observation observation = observation_of(stored, track);
  const BoxMeasurement measured =
      measure_box(box, supposed_centre_m(box, observation), observation, config);
  filters::MotionState start;
  start.mean.head<2>() = measured.centre_m - measured.recentring_m;
  start.covariance.topLeftCorner<2, 2>() = measured.covariance_m2 + stored.pose_covariance_m2;
  start.covariance.block<2, 2>(2, 2) =
      std::pow(0.5 * config.motion.fastest_mps, 2) * Matrix2d::Identity();
  start.covariance.block<2, 2>(4, 4) = std::pow(kIdleAccelerationMps2, 2) * Matrix2d::Identity();
  return start;
}

/// A box of constant size and heading, and its motion after all stored observations.
struct FilteredBox {
  Box box;
  filters::ImmState mixture;
  filters::MotionState estimate;
};

FilteredBox filtered(const Track& track, Box box, const TrackingConfig& config) {
  const filters::ModelSet models = motion_models(config);
  const ObservationHistory& observations = track.history.observations;
  filters::ImmState mixture = filters::imm_start(models, first_state(track, box, config));
  box.anchors = {};
  for (std::size_t i = 1; i < observations.size(); ++i) {
    const StoredObservation& stored = observations[i];
    mixture = filters::imm_predict(
        models, mixture,
        static_cast<double>(stored.stamp_ns - observations[i - 1].stamp_ns) * 1e-9);
    const Vector2d predicted_m = filters::imm_combine(models, mixture).mean.head<2>();
    const BoxMeasurement measured =
        measure_box(box, predicted_m, observation_of(stored, track), config);
    filters::imm_loosen(models, mixture, measured.step_covariance_m2);
    box.anchors = measured.box.anchors;
    mixture = filters::imm_update(models, mixture, measured.centre_m - measured.recentring_m,
                                  measured.covariance_m2 + stored.pose_covariance_m2)
                  .posterior;
  }
  return {box, mixture, filters::imm_combine(models, mixture)};
}

/// Of a velocity along the length of the box, at any speed.
double log_likelihood_of_course(const FilteredBox& filtered, const TrackingConfig& config) {
  const Vector2d velocity_mps = filtered.estimate.mean.segment<2>(2);
  const Matrix2d P = filtered.estimate.covariance.block<2, 2>(2, 2);
  const Vector2d along{std::cos(filtered.box.heading_rad), std::sin(filtered.box.heading_rad)};
  const Vector2d across{-along.y(), along.x()};
  const auto log_density = [&](const Vector2d& axis, double variance) {
    const double S = axis.dot(P * axis) + variance;
    return -0.5 * std::pow(axis.dot(velocity_mps), 2) / S - 0.5 * std::log(S);
  };
  return log_density(along, std::pow(0.5 * config.motion.fastest_mps, 2)) +
         log_density(across, std::pow(kSlipMps * config.extent.size_scale, 2) +
                                 kSlip * kSlip * velocity_mps.squaredNorm());
}

double log_likelihood(const FilteredBox& filtered, const TrackingConfig& config) {
  return log_likelihood_of_course(filtered, config) + log_evidence_of_sizes(filtered.box, config);
}

/// The box with its heading along its measured axis.
Box along_its_sides(Box box) {
  if (box.axis_variance_rad2 < kKnownAxisRad2)
    box.heading_rad += std::remainder(box.axis_rad - box.heading_rad, 0.5 * std::numbers::pi);
  box.heading_rad = geometry::wrap_angle(box.heading_rad);
  return box;
}

}  // namespace

Belief belief_of(const Track& track) {
  return {track.extent.outline, track.kinematics.mixture, track.kinematics.estimate,
          track.existence.consistency};
}

Belief refiltered(const Track& track, const TrackingConfig& config) {
  const Box* box = track.extent.box();
  if (box == nullptr || track.history.observations.size() < 2) return belief_of(track);
  FilteredBox best = filtered(track, along_its_sides(*box), config);
  const Box turned = turned_by_a_quarter(best.box, 1.0, config);
  if (is_plausible(turned, config)) {
    const FilteredBox other = filtered(track, turned, config);
    const double odds = log_likelihood(other, config) - log_likelihood(best, config);
    if (odds > 0.0) best = other;
    best.box.is_oriented = std::abs(odds) > kSureOdds;
  }
  return {best.box, best.mixture, best.estimate, {}};
}

void set_belief(Track& track, const Belief& belief) {
  const Vector2d by_m = belief.estimate.mean.head<2>() - track.position_m();
  track.extent.outline = belief.outline;
  track.kinematics.mixture = belief.mixture;
  track.kinematics.estimate = belief.estimate;
  track.kinematics.may_turn = false;
  track.kinematics.cruises_only = false;
  track.existence.consistency = belief.consistency;
  track.history.birth.centre_m += by_m;
  track.existence.travel.anchor_m += by_m;
  filters::move_stop_shift(track.kinematics.move_stop, by_m);
}

}  // namespace slammot::tracking
