#pragma once

#include <vector>

#include "common/flow/tracked_objects.hpp"
#include "services/collision_warning/collision_warning_config.hpp"
#include "services/collision_warning/oriented_box.hpp"
#include "services/collision_warning/vehicle_motion.hpp"

namespace slammot::collision_warning {

/// A footprint at a later time, with the covariance of its position [m^2]; both in odom.
struct PredictedBox {
  OrientedBox box;
  Eigen::Matrix2d covariance_m2 = Eigen::Matrix2d::Zero();
};

/// Footprints at equal steps of time from now on.
using PredictedBoxes = std::vector<PredictedBox>;

inline constexpr double kPredictionStepS = 0.1;

/// Number of footprints up to the horizon, the present one included.
std::size_t steps_of(const CollisionWarningConfig& config);

/// The vehicle goes on along the arc of its present turn. Braking goes on until it stands; a speed
/// that increases is held. The covariance is relative to the present pose: the objects' contains
/// that of the pose. It grows by what the driver may do: t^2/2 times a constant acceleration and,
/// across, speed times a constant yaw rate.
PredictedBoxes predict(const VehicleState& vehicle, const CollisionWarningConfig& config);

/// The object follows the path that tracking predicts by the mixture of its modes, by a cubic
/// between the given positions, and goes straight on after the last. Without a path it keeps its
/// velocity. Its heading stays.
PredictedBoxes predict(const flow::TrackedObject& object, const CollisionWarningConfig& config);

}  // namespace slammot::collision_warning
