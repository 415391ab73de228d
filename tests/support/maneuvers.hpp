#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>
#include <vector>

#include <Eigen/Core>

#include "common/filters/model_set.hpp"
#include "common/filters/motion_models.hpp"

/// The simulations of Wang 2004, Section 4.3: a point, seen from a scanner at rest with a noise of
/// 0.1 m. What the text does not say (the sampling period, the phases of the move-stop-move
/// maneuver) is chosen here.
namespace slammot::testing {

using filters::Vector6;
using Maneuver = std::function<Vector6(double time_s)>;

inline constexpr double kManeuverSigmaM = 0.1;
inline constexpr double kManeuverPeriodS = 0.1;

/// The models that follow them.
inline filters::ModelSet velocity_and_acceleration() {
  filters::ModelSet set;
  set.models[0] = {filters::MotionKind::kConstantVelocity, 0.05, 3.0};
  set.models[1] = {filters::MotionKind::kConstantAcceleration, 20.0, 0.0};
  set.size = 2;
  set.mean_stay_s = 2.0;
  return set;
}

inline Vector6 along_x(double x_m, double speed_mps, double acceleration_mps2) {
  Vector6 state;
  state << x_m, 0.0, speed_mps, 0.0, acceleration_mps2, 0.0;
  return state;
}

/// Case 1, Figures 4.2 and 4.3.
inline Vector6 accelerating(double t) {
  return along_x(5.0 * t + 5.0 * t * t, 5.0 + 10.0 * t, 10.0);
}

/// Case 2, Figures 4.4 and 4.5.
inline Vector6 cruising(double t) { return along_x(15.0 * t, 15.0, 0.0); }

/// Case 3, Figures 4.6 and 4.7.
inline Vector6 turning(double t) {
  const double rate_radps = 18.0 * M_PI / 180.0;
  const double angle = rate_radps * t;
  Vector6 state;
  state << 15.0 / rate_radps * std::sin(angle), 15.0 / rate_radps * (1.0 - std::cos(angle)),
      15.0 * std::cos(angle), 15.0 * std::sin(angle), -15.0 * rate_radps * std::sin(angle),
      15.0 * rate_radps * std::cos(angle);
  return state;
}

inline Vector6 standing(double) { return Vector6::Zero(); }

/// When the phases of the move-stop-move maneuver end.
inline constexpr double kBrakesAtS = 2.0;
inline constexpr double kStandsAtS = 4.0;
inline constexpr double kStartsAtS = 9.0;
inline constexpr double kCruisesAtS = 11.0;
inline constexpr double kStopXM = 30.0;

/// Case 4, Figures 4.8 and 4.9: 10 m/s, 5 m/s^2 down to a stop of 5 s, and the same back.
inline Vector6 moving_stopping_moving(double t) {
  if (t < kBrakesAtS) return along_x(10.0 * t, 10.0, 0.0);
  if (t < kStandsAtS)
    return along_x(kStopXM - 2.5 * (kStandsAtS - t) * (kStandsAtS - t), 5.0 * (kStandsAtS - t),
                   -5.0);
  if (t < kStartsAtS) return along_x(kStopXM, 0.0, 0.0);
  if (t < kCruisesAtS)
    return along_x(kStopXM + 2.5 * (t - kStartsAtS) * (t - kStartsAtS), 5.0 * (t - kStartsAtS),
                   5.0);
  return along_x(kStopXM + 10.0 + 10.0 * (t - kCruisesAtS), 10.0, 0.0);
}

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
