#pragma once

#include <optional>
#include <vector>

#include "common/simulation/maneuvers.hpp"
#include "examples/motion_study/estimator.hpp"

namespace slammot::motion_study {

/// One measurement of one run.
struct Sample {
  double time_s = 0.0;
  simulation::MotionVector truth = simulation::MotionVector::Zero();
  Eigen::Vector2d measured_m = Eigen::Vector2d::Zero();
  Estimate estimate;
};

/// One run of a method over a maneuver. The filter starts with the true place, known as well as by
/// one measurement, and with a velocity of zero, with a sigma of 10 m/s.
std::vector<Sample> run(Method method, const simulation::Maneuver& maneuver, std::uint64_t seed);

/// Part of a maneuver that counts.
struct Span {
  double from_s = 0.0;
  double until_s = 0.0;
};

/// Means over runs.
struct Score {
  double position_rmse_m = 0.0;
  double velocity_rmse_mps = 0.0;
  double position_nees = 0.0;  ///< 2 for a consistent covariance.
  double velocity_nees = 0.0;
};

Score score_of(Method method, const simulation::Maneuver& maneuver, const Span& span, int seeds);

/// Mean time [s] from a change of the true mode to the first estimate with the new mode; a change
/// that is missed counts with the time until the next. None for a method with one model. Methods
/// without a stop model are asked to stop accelerating when the object stands.
std::optional<double> mode_delay_s(Method method, const simulation::Maneuver& maneuver, int seeds);

}  // namespace slammot::motion_study
