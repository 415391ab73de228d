#pragma once

#include <optional>

#include <Eigen/Core>

#include "common/filters/imm.hpp"
#include "common/filters/move_stop.hpp"
#include "common/flow/tracked_objects.hpp"
#include "services/tracking/gait_noise.hpp"
#include "services/tracking/tracking_config.hpp"

namespace slammot::tracking {

/// Measured position of a centre, in odom.
struct MeasuredCentre {
  Eigen::Vector2d centre_m = Eigen::Vector2d::Zero();
  Eigen::Matrix2d R = Eigen::Matrix2d::Identity();
};

/// Position, velocity and acceleration of an object's centre in odom: a mixture over motion modes
/// (IMM; Wang 2004, Section 2.3) and a move-stop hypothesis beside it (Section 4.6). Invariant:
/// `estimate` is the moment-matched mixture, except between a change of the mixture and combine().
struct Kinematics {
  filters::ImmState mixture;
  filters::MotionState estimate;  ///< Of the move hypothesis.
  double time_offset_s = 0.0;  ///< Time of the estimate after the scan's stamp: when the beam that
                               ///< points at it is fired.
  filters::MoveStop move_stop;
  flow::Motion state = flow::Motion::kMoving;
  std::optional<MeasuredCentre> measured;                 ///< In the current scan, if observed.
  Eigen::Vector2d recentred_m = Eigen::Vector2d::Zero();  ///< Step of the centre in the current
                                                          ///< scan by a change of the extent.
  double innovation_m = 0.0;  ///< Length of the last innovation of the position.
  GaitNoise gait;             ///< Of a pedestrian.
  bool may_turn = false;  ///< The coordinated turn is one of the modes, as of the last prediction.
  bool cruises_only = false;  ///< Constant velocity is the only mode, as of the last prediction.

  Eigen::Vector2d position_m() const { return estimate.mean.head<2>(); }
  Eigen::Vector2d velocity_mps() const { return estimate.mean.segment<2>(2); }
  Eigen::Matrix2d position_covariance_m2() const {
    return estimate.covariance.topLeftCorner<2, 2>();
  }
  Eigen::Matrix2d velocity_covariance() const { return estimate.covariance.block<2, 2>(2, 2); }
};

/// One sigma of the acceleration along each axis that constant velocity neglects.
inline constexpr double kIdleAccelerationMps2 = 0.5;
/// Sigmas of the velocity above which an object surely moves (Wang 2004, Section 4.6).
inline constexpr double kDetectionSigmas = 2.0;
/// Sigma of the velocity below which the velocity is known. Confirmed at 0.4 m/s pedestrians, buses
/// and trucks come later: docs/decisions/existence-and-publication.md.
inline constexpr double kKnownSpeedSigmaMps = 0.5;

/// Constant velocity and constant acceleration: the modes of every object.
filters::ModelSet motion_models(const TrackingConfig& config);

/// The modes of this object, as of the last prediction.
filters::ModelSet models_of(const Kinematics& kinematics, const TrackingConfig& config);

/// One sigma of the velocity along one axis [m/s].
double speed_sigma_mps(const Kinematics& kinematics);

/// Direction of the velocity.
struct Course {
  double heading_rad = 0.0;
  double variance_rad2 = 10.0;
};

Course course_of(const Kinematics& kinematics);

/// Prediction over time_s (>= 0) by the modes that may_turn and cruises_only select.
void predict(Kinematics& kinematics, double time_s, const TrackingConfig& config);

/// Sets the estimate to the moment-matched mixture.
void combine(Kinematics& kinematics, const TrackingConfig& config);

/// Moves the reference point of the position; the velocity stays. The estimate is the caller's to
/// combine.
void shift(Kinematics& kinematics, const Eigen::Vector2d& by_m, const TrackingConfig& config);

/// Restarts all modes from this state.
void restart_from(Kinematics& kinematics, const filters::MotionState& state,
                  const TrackingConfig& config);

/// Restarts all modes at the same position with another velocity.
void restart_velocity(Kinematics& kinematics, const Eigen::Vector2d& velocity_mps, double sigma_mps,
                      const TrackingConfig& config);

/// Direction of the length of a box.
struct AxisConstraint {
  double axis_rad = 0.0;
  double axis_variance_rad2 = 0.0;
  bool is_measured_now = true;  ///< By a visible side.
  double time_s = 0.0;          ///< Since the last update.
};

/// Update by the non-holonomic constraint: wheels do not slip sideways, so the velocity is along
/// the axis of the box. In a bend the sides turn at once, and the course only after the filter has
/// seen the centre leave its line.
void constrain_to_axis(Kinematics& kinematics, const AxisConstraint& constraint,
                       const TrackingConfig& config);

/// One sigma of the velocity across the axis of a box: a share of the speed,
inline constexpr double kSlip = 0.08;
/// and a constant, since the tracked centre need not be the centre of rotation.
inline constexpr double kSlipMps = 0.3;

}  // namespace slammot::tracking
