#pragma once

#include <Eigen/Core>

#include "common/filters/motion_models.hpp"

namespace slammot::filters {

struct MoveStopConfig {
  double memory_s;               ///< For which measurements count in the stop hypothesis, > 0; older ones fade.
  double detection_sigmas;       ///< Of the velocity estimate's uncertainty: what is faster surely moves.
};

/// Measured positions as a second-order stationary series, identified locally: Wang 2004, Section 4.4. Older ones fade.
struct StationaryProcess {
  double age_s = 0.0;                                        ///< Since the first measurement.
  double weight = 0.0;                                       ///< Sum of the faded weights,
  double squared_weight = 0.0;                               ///< and of their squares,
  double step_weight = 0.0;                                  ///< and of those of the steps from one to the next.
  Eigen::Vector2d mean_m = Eigen::Vector2d::Zero();
  Eigen::Matrix2d scatter_m2 = Eigen::Matrix2d::Zero();      ///< Faded sum of the squared deviations from the mean,
  Eigen::Matrix2d differences_m2 = Eigen::Matrix2d::Zero();  ///< and of half the squared steps.
  Eigen::Vector2d last_m = Eigen::Vector2d::Zero();

  /// Covariance of the series itself, m^2: of something that moves it grows with the way.
  Eigen::Matrix2d covariance_m2() const;

  /// Covariance of the mean as the place of the object, m^2. What differs from one measurement to the next averages out;
  /// what is left of the series' covariance (a way, a drift) does not.
  Eigen::Matrix2d mean_covariance_m2() const;
};

/// The series with one more position, after_s (>= 0) after the last.
StationaryProcess observed(const StationaryProcess& series, const Eigen::Vector2d& position_m, double after_s, double memory_s);

/// Speed that an estimate must have to be told from none, m/s: so many sigmas of its velocity, in which all modelled
/// sources of uncertainty are (sensor, pose, motion); Wang 2004, Section 4.6.
double minimum_detection_speed_mps(const MotionState& moving, double sigmas);

/// The move hypothesis is an estimate by moving models, kept by whoever owns this; the stop hypothesis is inferred beside it.
struct MoveStop {
  StationaryProcess series;
  bool stands = false;       ///< Whether the stop hypothesis has taken over.
};

/// What happens at one scan.
struct MoveStopScan {
  MotionState moving;        ///< The move hypothesis after the measurement
  Eigen::Vector2d position_m = Eigen::Vector2d::Zero();  ///< of this position,
  double after_s = 0.0;      ///< so long (>= 0) after the last.
};

/// Move-stop hypothesis tracking, Wang 2004, Section 4.6. What is surely faster than nothing moves, and the series begins
/// anew; of the others the hypothesis that is more certain of the position holds, once the series is as long as its memory.
MoveStop weigh(const MoveStop& before, const MoveStopScan& scan, const MoveStopConfig& config);

/// The estimate of the hypothesis that holds: while standing the series' mean, no velocity and no acceleration. That there is
/// none is as sure as the move hypothesis' velocity, which could not be told from none.
MotionState estimate_of(const MoveStop& hypotheses, const MotionState& moving);

/// Moves the series by a known amount: the same object seen from another reference point.
void move_stop_shift(MoveStop& hypotheses, const Eigen::Vector2d& shift_m);

}  // namespace slammot::filters
