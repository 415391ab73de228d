#pragma once

#include <Eigen/Core>

#include "common/filters/motion_models.hpp"

namespace slammot::filters {

struct MoveStopConfig {
  double memory_s;          ///< Memory of the stop hypothesis, > 0; older measurements fade.
  double detection_sigmas;  ///< Threshold in sigmas of the velocity estimate; a faster object moves
                            ///< with certainty.
};

/// Measured positions as a second-order stationary series, identified locally: Wang 2004,
/// Section 4.4. Old measurements fade.
struct StationaryProcess {
  double age_s = 0.0;           ///< Time since the first measurement.
  double weight = 0.0;          ///< Sum of the faded weights.
  double squared_weight = 0.0;  ///< Sum of their squares.
  double step_weight = 0.0;  ///< Sum of the faded weights of steps between successive measurements.
  Eigen::Vector2d mean_m = Eigen::Vector2d::Zero();
  Eigen::Matrix2d scatter_m2 = Eigen::Matrix2d::Zero();  ///< Faded sum of squared deviations from
                                                         ///< the mean.
  Eigen::Matrix2d differences_m2 = Eigen::Matrix2d::Zero();  ///< Faded sum of half the squared
                                                             ///< steps.
  Eigen::Vector2d last_m = Eigen::Vector2d::Zero();

  /// Covariance of the series [m^2]; it grows with the distance if the object moves.
  Eigen::Matrix2d covariance_m2() const;

  /// Covariance of the mean as the object's position [m^2]. The part that differs between
  /// successive measurements averages out. The rest of the series' covariance (motion, drift) does
  /// not.
  Eigen::Matrix2d mean_covariance_m2() const;
};

/// Adds one position, after_s (>= 0) after the last one.
StationaryProcess observed(const StationaryProcess& series, const Eigen::Vector2d& position_m,
                           double after_s, double memory_s);

/// Least speed [m/s] that differs significantly from zero: detection_sigmas times the velocity
/// sigma, which includes all modelled uncertainty (sensor, pose, motion); Wang 2004, Section 4.6.
double minimum_detection_speed_mps(const MotionState& moving, double sigmas);

/// The caller keeps the move hypothesis, an estimate by motion models; this keeps the stop
/// hypothesis.
struct MoveStop {
  StationaryProcess series;
  bool stands = false;  ///< True if the stop hypothesis is selected.
};

/// Input of one scan.
struct MoveStopScan {
  MotionState moving;                                    ///< Move hypothesis after the update
  Eigen::Vector2d position_m = Eigen::Vector2d::Zero();  ///< with this measured position.
  double after_s = 0.0;                                  ///< Time since the last measurement, >= 0.
};

/// Move-stop hypothesis tracking, Wang 2004, Section 4.6. If the speed is significant, the series
/// restarts. Otherwise the hypothesis with the more certain position is selected, once the series
/// is as long as its memory.
MoveStop weigh(const MoveStop& before, const MoveStopScan& scan, const MoveStopConfig& config);

/// Estimate of the selected hypothesis. While stopped: mean of the series, zero velocity and
/// acceleration. The velocity covariance is that of the move hypothesis, since its velocity did not
/// differ significantly from zero.
MotionState estimate_of(const MoveStop& hypotheses, const MotionState& moving);

/// Shifts the series by a known offset: a change of the reference point.
void move_stop_shift(MoveStop& hypotheses, const Eigen::Vector2d& shift_m);

}  // namespace slammot::filters
