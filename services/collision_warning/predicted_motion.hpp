#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "common/flow/tracked_objects.hpp"
#include "services/collision_warning/collision_warning_config.hpp"
#include "services/collision_warning/object_motion.hpp"
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

/// The vehicle goes on along its present turn, which straightens out. Braking goes on until it
/// stands; a speed that increases is held. The covariance is relative to the present pose: the
/// objects' contains that of the pose. It grows by what the driver may do: t^2/2 times a constant
/// acceleration and, across, speed times a constant yaw rate.
PredictedBoxes predict(const VehicleState& vehicle, const CollisionWarningConfig& config);

/// The object goes on like the vehicle: along its course with its turn, braking until it stands. On
/// the road of the vehicle, its course turns into the road's direction: a lane change ends in a
/// lane, oncoming traffic keeps to its side. The published covariance of place and velocity grows
/// by what its driver, or the pedestrian, may do. This is the question of a warning, what happens
/// if both go on as they do. The path that tracking publishes answers another one, where the object
/// will be: it contains that it may brake and turn, and is therefore several times as wide.
/// `road_rad`: direction of the road in odom, if the vehicle follows one.
PredictedBoxes predict(const flow::TrackedObject& object, const CourseState& motion,
                       const std::optional<double>& road_rad, const CollisionWarningConfig& config);

/// The vehicle's heading, unless it turns.
std::optional<double> road_of(const VehicleState& vehicle);

}  // namespace slammot::collision_warning
