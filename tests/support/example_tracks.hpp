// Tracks in typical states, and what is done with them in several tests.
#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

#include <gtest/gtest.h>
#include <Eigen/Core>

#include "services/tracking/confirmation.hpp"
#include "services/tracking/evidence_limits.hpp"
#include "services/tracking/measurement_update.hpp"
#include "services/tracking/track.hpp"
#include "services/tracking/tracking_config.hpp"

namespace slammot::testing {

using tracking::Blob;
using tracking::Box;
using tracking::Observation;
using tracking::Track;
using tracking::TrackingConfig;

inline constexpr double kPeriodS = 0.027;

/// Believed in, on its way, and known to be a car.
inline Track followed_car() {
  Track track;
  track.existence.confirmed = true;
  track.existence.score = 5.0;
  track.existence.travel.travelled_m = 10.0;
  track.extent.outline = Box();
  track.extent.footprint().length = {4.4, 0.04};
  track.extent.footprint().width = {1.8, 0.01};
  track.kinematics.estimate.mean << 20.0, 0.0, 5.0, 0.0, 0.0, 0.0;
  track.kinematics.estimate.covariance = 0.01 * track.kinematics.estimate.covariance.Identity();
  return track;
}

/// A car seen from behind, of which the sides are known.
inline Track known_car() {
  Track track;
  track.existence.confirmed = true;
  track.existence.travel.travelled_m = 20.0;
  track.extent.outline = Box();
  track.extent.box()->is_oriented = true;
  track.extent.box()->evidence.length = {4.5, {4.6, 0.004}};
  track.extent.box()->evidence.width = {1.7, {1.8, 0.004}};
  track.extent.box()->corner_seen = {0.1, 0.001};
  track.extent.box()->heading_variance_rad2 = 0.0016;
  track.extent.box()->axis_variance_rad2 = 0.0016;
  *track.extent.box() = with_likely_sizes(*track.extent.box(), {});
  track.kinematics.mixture =
      filters::imm_start(tracking::motion_models({}), track.kinematics.estimate);
  return track;
}

/// Followed for long, at 1.3 m/s along x, so far from the laser that lies beside their way.
inline Track known_walker(double x_m, const TrackingConfig& config) {
  Track track;
  track.existence.confirmed = true;
  track.existence.score = 5.0;
  track.existence.hits = 100;
  track.existence.travel.travelled_m = 5.0;
  track.extent.footprint().length = {0.5, 0.01};
  track.extent.footprint().width = {0.5, 0.01};
  track.extent.blob()->was_seen_whole = true;
  track.extent.largest_span_m = 0.5;
  for (int i = 0; i < 150; ++i)
    track.classification.speeds =
        with_speed(track.classification.speeds, {1.3, 0.2, kPeriodS}, config);
  track.classification.probability =
      class_probabilities(track.extent.outline, track.classification.speeds, config);
  filters::MotionState motion;
  motion.mean << x_m, 8.0, 1.3, 0.0, 0.0, 0.0;
  motion.covariance = 0.02 * motion.covariance.Identity();
  restart_from(track.kinematics, motion, config);
  return track;
}

/// One scan later there are echoes of somebody, or of something this wide, about this place.
inline void see(Track& track, const Eigen::Vector2d& middle_m, double width_m,
                const TrackingConfig& config) {
  std::vector<Eigen::Vector2d> points_m;
  for (int i = 0; i < 7; ++i)
    points_m.emplace_back(middle_m.x() + width_m * (i / 6.0 - 0.5), middle_m.y() - 0.1);
  Observation observation;
  observation.points_m = points_m;
  observation.beam_step_rad = 0.009;
  predict(track, kPeriodS, config);
  ASSERT_TRUE(update(track, track.history.last_seen_ns + 27'000'000, observation,
                     Eigen::Matrix2d::Zero(), config));
}

/// As the profile of a slow robot in a building says.
inline TrackingConfig among_people() {
  TrackingConfig config;
  config.motion.fastest_mps = 5.0;
  config.extent.longest_body_m = 2.0;
  config.existence.contradicted_above_mps = 0.6;
  return config;
}

/// Something fast that has come far, of which earlier scans could hardly see the places where it
/// was.
inline Track out_from_behind_others(const TrackingConfig& config) {
  Track track;
  track.existence.score = tracking::kConfirmScore;
  track.existence.hits = tracking::evidence_limits(config).least_hits;
  track.existence.mean_echoes = 5.0;
  track.existence.motion = {3.0, 0.0, 30.0};
  track.existence.tentative = {40.0, 36.0, 0.0};
  track.history.birth.R = 0.01 * Eigen::Matrix2d::Identity();
  track.kinematics.estimate.mean << 2.0, 0.0, 8.0, 0.0, 0.0, 0.0;
  track.kinematics.estimate.covariance = 0.01 * filters::Matrix6::Identity();
  return track;
}

}  // namespace slammot::testing
