#include "services/collision_warning/predicted_motion.hpp"

#include <algorithm>
#include <cmath>

namespace slammot::collision_warning {
namespace {

using Eigen::Matrix2d;
using Eigen::Vector2d;
using geometry::Pose2;

/// Density of white acceleration of an object whose path is not given [m^2/s^3].
constexpr double kAccelerationDensity = 0.3;
/// Below it a vehicle's curvature is that of noise.
constexpr double kLeastTurningSpeedMps = 1.0;

/// Way of a vehicle that keeps its speed, or brakes until it stands; signed.
double way_m(const VehicleState& vehicle, double after_s) {
  const bool brakes = vehicle.speed_mps * vehicle.acceleration_mps2 < 0.0;
  if (!brakes) return vehicle.speed_mps * after_s;
  const double until_stop_s = -vehicle.speed_mps / vehicle.acceleration_mps2;
  const double t = std::min(after_s, until_stop_s);
  return vehicle.speed_mps * t + 0.5 * vehicle.acceleration_mps2 * t * t;
}

double curvature_of(const VehicleState& vehicle) {
  const double v = vehicle.speed_mps;
  return vehicle.yaw_rate_radps * v / std::max(v * v, kLeastTurningSpeedMps);
}

/// End of an arc that begins at the origin along x.
Pose2 end_of_arc(double length_m, double curvature_per_m) {
  const double turn_rad = length_m * curvature_per_m;
  if (std::abs(turn_rad) < 1e-9) return {length_m, 0.0, 0.0};
  return {std::sin(turn_rad) / curvature_per_m, (1.0 - std::cos(turn_rad)) / curvature_per_m,
          geometry::wrap_angle(turn_rad)};
}

/// Covariance of the position in the axes of the predicted pose, rotated to odom.
Matrix2d driver_covariance_m2(const VehicleState& vehicle, double after_s, double heading_rad,
                              const CollisionWarningConfig& config) {
  const double half_t2 = 0.5 * after_s * after_s;
  const double along_m = half_t2 * config.acceleration_sigma_mps2;
  const double across_m = half_t2 * config.yaw_rate_sigma_radps * std::abs(vehicle.speed_mps);
  const Matrix2d turn = geometry::rotation(heading_rad);
  return turn * Vector2d(along_m * along_m, across_m * across_m).asDiagonal() * turn.transpose();
}

/// The path's positions with the present one before them.
std::vector<flow::PredictedPosition> nodes_of(const flow::TrackedObject& object) {
  std::vector<flow::PredictedPosition> nodes = {
      {0.0, object.position_in_odom_m, object.covariance.topLeftCorner<2, 2>()}};
  for (const flow::PredictedPosition& place : object.predicted_path) {
    if (place.after_s > nodes.back().after_s) nodes.push_back(place);
  }
  return nodes;
}

/// Velocity at a node: the object's at the first, central differences at the others (Catmull and
/// Rom 1974).
Vector2d tangent_at(const std::vector<flow::PredictedPosition>& nodes, std::size_t i,
                    const Vector2d& velocity_mps) {
  if (i == 0) return velocity_mps;
  const flow::PredictedPosition& before = nodes[i - 1];
  const flow::PredictedPosition& next = nodes[std::min(i + 1, nodes.size() - 1)];
  return (next.position_in_odom_m - before.position_in_odom_m) / (next.after_s - before.after_s);
}

/// Cubic between two nodes (Hermite), and linear covariance.
flow::PredictedPosition between(const flow::PredictedPosition& a, const Vector2d& a_mps,
                                const flow::PredictedPosition& b, const Vector2d& b_mps,
                                double after_s) {
  const double h = b.after_s - a.after_s;
  const double u = (after_s - a.after_s) / h;
  const double u2 = u * u;
  const double u3 = u2 * u;
  return {after_s,
          (2.0 * u3 - 3.0 * u2 + 1.0) * a.position_in_odom_m + h * (u3 - 2.0 * u2 + u) * a_mps +
              (3.0 * u2 - 2.0 * u3) * b.position_in_odom_m + h * (u3 - u2) * b_mps,
          (1.0 - u) * a.covariance_m2 + u * b.covariance_m2};
}

/// Straight on, with sigmas that grow with time.
flow::PredictedPosition beyond(const flow::PredictedPosition& last, const Vector2d& velocity_mps,
                               double after_s) {
  const double growth = after_s / last.after_s;
  return {after_s, last.position_in_odom_m + (after_s - last.after_s) * velocity_mps,
          growth * growth * last.covariance_m2};
}

flow::PredictedPosition position_after(const std::vector<flow::PredictedPosition>& nodes,
                                       const Vector2d& velocity_mps, double after_s) {
  const auto later = std::ranges::find_if(
      nodes, [&](const flow::PredictedPosition& node) { return node.after_s > after_s; });
  const auto i = static_cast<std::size_t>(later - nodes.begin());
  if (later == nodes.end())
    return beyond(nodes.back(), tangent_at(nodes, i - 1, velocity_mps), after_s);
  return between(nodes[i - 1], tangent_at(nodes, i - 1, velocity_mps), nodes[i],
                 tangent_at(nodes, i, velocity_mps), after_s);
}

/// Constant velocity with white acceleration.
flow::PredictedPosition position_without_path(const flow::TrackedObject& object, double after_s) {
  const Matrix2d P = object.covariance.topLeftCorner<2, 2>();
  const Matrix2d C = object.covariance.topRightCorner<2, 2>();
  const Matrix2d V = object.covariance.bottomRightCorner<2, 2>();
  const double t = after_s;
  return {t, object.position_in_odom_m + t * object.velocity_in_odom_mps,
          P + t * (C + C.transpose()) + t * t * V +
              kAccelerationDensity * t * t * t / 3.0 * Matrix2d::Identity()};
}

}  // namespace

std::size_t steps_of(const CollisionWarningConfig& config) {
  return static_cast<std::size_t>(std::lround(config.horizon_s / kPredictionStepS)) + 1;
}

PredictedBoxes predict(const VehicleState& vehicle, const CollisionWarningConfig& config) {
  const Pose2 base_from_centre{config.vehicle_centre_ahead_m, 0.0, 0.0};
  PredictedBoxes boxes(steps_of(config));
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    const double after_s = kPredictionStepS * static_cast<double>(i);
    const Pose2 odom_from_base =
        vehicle.odom_from_base * end_of_arc(way_m(vehicle, after_s), curvature_of(vehicle));
    boxes[i] = {
        {odom_from_base * base_from_centre, config.vehicle_length_m, config.vehicle_width_m},
        driver_covariance_m2(vehicle, after_s, odom_from_base.heading_rad, config)};
  }
  return boxes;
}

PredictedBoxes predict(const flow::TrackedObject& object, const CollisionWarningConfig& config) {
  const std::vector<flow::PredictedPosition> nodes = nodes_of(object);
  PredictedBoxes boxes(steps_of(config));
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    const double after_s = kPredictionStepS * static_cast<double>(i);
    const flow::PredictedPosition there =
        nodes.size() > 1 ? position_after(nodes, object.velocity_in_odom_mps, after_s)
                         : position_without_path(object, after_s);
    boxes[i] = {
        {{there.position_in_odom_m.x(), there.position_in_odom_m.y(), object.heading_in_odom_rad},
         object.length_m,
         object.width_m},
        there.covariance_m2};
  }
  return boxes;
}

}  // namespace slammot::collision_warning
