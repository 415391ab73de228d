#pragma once

#include <random>
#include <vector>

#include <Eigen/Core>

#include "common/filters/model_set.hpp"
#include "common/filters/motion_models.hpp"
#include "common/simulation/maneuvers.hpp"

/// The simulated motions of common/simulation/maneuvers.hpp, measured, and filters for them.
namespace slammot::testing {

using filters::Vector6;
using Maneuver = simulation::StateAt;

/// The models that follow them.
inline filters::ModelSet velocity_and_acceleration() {
  filters::ModelSet set;
  set.models[0] = {filters::MotionKind::kConstantVelocity, 0.05, 3.0};
  set.models[1] = {filters::MotionKind::kConstantAcceleration, 20.0, 0.0};
  set.size = 2;
  set.mean_stay_s = 2.0;
  return set;
}

using simulation::accelerating;
using simulation::cruising;
using simulation::kBrakesAtS;
using simulation::kCruisesAtS;
using simulation::kManeuverPeriodS;
using simulation::kManeuverSigmaM;
using simulation::kStandsAtS;
using simulation::kStartsAtS;
using simulation::kStopXM;
using simulation::moving_stopping_moving;
using simulation::standing;
using simulation::turning;

/// Positions measured at the periods 1, 2, ...
inline std::vector<Eigen::Vector2d> measured(const Maneuver& truth_at, int scans, unsigned seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  std::vector<Eigen::Vector2d> positions_m;
  for (int scan = 1; scan <= scans; ++scan) {
    const Eigen::Vector2d truth_m = truth_at(scan * kManeuverPeriodS).head<2>();
    const double x_m = normal(random);
    positions_m.push_back(truth_m + kManeuverSigmaM * Eigen::Vector2d(x_m, normal(random)));
  }
  return positions_m;
}

inline Eigen::Matrix2d maneuver_noise_m2() {
  return kManeuverSigmaM * kManeuverSigmaM * Eigen::Matrix2d::Identity();
}

/// A start that knows the place as well as one measurement, and little of the speed.
inline filters::MotionState start_of(const Maneuver& truth_at) {
  filters::MotionState start;
  start.mean.head<2>() = truth_at(0.0).head<2>();
  start.covariance.diagonal() << 0.01, 0.01, 100.0, 100.0, 25.0, 25.0;
  return start;
}

}  // namespace slammot::testing
