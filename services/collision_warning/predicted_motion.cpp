#include "services/collision_warning/predicted_motion.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

namespace slammot::collision_warning {
namespace {

using Eigen::Matrix2d;
using Eigen::Vector2d;
using geometry::Pose2;

/// Below it a curvature is that of noise.
constexpr double kLeastTurningSpeedMps = 1.0;
/// A course turns into the direction of the road with this time constant, that of a lane change,
constexpr double kRoadS = 1.2;
/// from up to this angle, in either sense of the road;
constexpr double kRoadRad = 0.5;
/// a vehicle that turns faster is on no road.
constexpr double kTurnsRadps = 0.12;

/// Motion along a course, as of the vehicle and of objects.
struct Motion {
  double speed_mps = 0.0;  ///< Signed.
  double acceleration_mps2 = 0.0;
  double yaw_rate_radps = 0.0;
  std::optional<double> road_rad{};  ///< Direction that the course turns into; in place of the
                                     ///< turn.
};

/// Way of one that keeps its speed, or brakes until it stands; signed.
double way_m(const Motion& motion, double after_s) {
  const bool brakes = motion.speed_mps * motion.acceleration_mps2 < 0.0;
  if (!brakes) return motion.speed_mps * after_s;
  const double until_stop_s = -motion.speed_mps / motion.acceleration_mps2;
  const double t = std::min(after_s, until_stop_s);
  return motion.speed_mps * t + 0.5 * motion.acceleration_mps2 * t * t;
}

double curvature_of(const Motion& motion) {
  const double v = motion.speed_mps;
  return motion.yaw_rate_radps * v / std::max(v * v, kLeastTurningSpeedMps);
}

/// End of an arc that begins at the origin along x.
Pose2 end_of_arc(double length_m, double curvature_per_m) {
  const double turn_rad = length_m * curvature_per_m;
  if (std::abs(turn_rad) < 1e-9) return {length_m, 0.0, 0.0};
  return {std::sin(turn_rad) / curvature_per_m, (1.0 - std::cos(turn_rad)) / curvature_per_m,
          geometry::wrap_angle(turn_rad)};
}

/// Course on a road after some time.
double towards(double road_rad, const Pose2& start, double after_s) {
  const double left_rad = geometry::wrap_angle(start.heading_rad - road_rad);
  return geometry::wrap_angle(road_rad + std::exp(-after_s / kRoadS) * left_rad);
}

/// The road's direction in the sense of the course, if the object is on the road.
std::optional<double> road_along(const std::optional<double>& road_rad, double course_rad) {
  if (!road_rad) return std::nullopt;
  const bool is_oncoming = std::cos(course_rad - *road_rad) < 0.0;
  const double along_rad =
      geometry::wrap_angle(is_oncoming ? *road_rad + std::numbers::pi : *road_rad);
  if (std::abs(geometry::wrap_angle(course_rad - along_rad)) > kRoadRad) return std::nullopt;
  return along_rad;
}

/// Poses at all steps, from `start` on, whose x axis is the course.
std::vector<Pose2> path_of(const Pose2& start, const Motion& motion, std::size_t steps) {
  std::vector<Pose2> path{start};
  path.reserve(steps);
  const double curvature_per_m = curvature_of(motion);
  double travelled_m = 0.0;
  for (std::size_t i = 1; i < steps; ++i) {
    const double after_s = kPredictionStepS * static_cast<double>(i);
    const double next_m = way_m(motion, after_s);
    const double left = std::exp(-(after_s - 0.5 * kPredictionStepS) / kTurnS);
    path.push_back(path.back() * end_of_arc(next_m - travelled_m, left * curvature_per_m));
    if (motion.road_rad) path.back().heading_rad = towards(*motion.road_rad, start, after_s);
    travelled_m = next_m;
  }
  return path;
}

/// Sigmas of a constant acceleration along the course and across it, and what they come to.
Matrix2d drift_m2(double along_mps2, double across_mps2, double after_s, double course_rad) {
  const double half_t2 = 0.5 * after_s * after_s;
  const Vector2d sigma_m{half_t2 * along_mps2, half_t2 * across_mps2};
  const Matrix2d turn = geometry::rotation(course_rad);
  return turn * sigma_m.cwiseAbs2().asDiagonal() * turn.transpose();
}

/// Covariance of the place of a pedestrian at constant velocity.
Matrix2d carried_m2(const Eigen::Matrix4d& covariance, double after_s) {
  const Matrix2d C = covariance.topRightCorner<2, 2>();
  return covariance.topLeftCorner<2, 2>() + after_s * (C + C.transpose()) +
         after_s * after_s * covariance.bottomRightCorner<2, 2>();
}

/// The same of a vehicle: along the course by the velocity, across it by course and turn.
Matrix2d carried_m2(const Eigen::Matrix4d& covariance, const CourseState& motion, bool is_on_road,
                    double after_s) {
  const Matrix2d turn = geometry::rotation(motion.course_rad);
  const double speed_m2ps2 = turn.col(0).dot(covariance.bottomRightCorner<2, 2>() * turn.col(0));
  const Vector2d by_turn =
      is_on_road ? Vector2d(motion.speed_mps * kRoadS * -std::expm1(-after_s / kRoadS), 0.0)
                 : motion.speed_mps * after_s * Vector2d(1.0, 0.5 * std::min(after_s, kTurnS));
  const Vector2d variance_m2{after_s * after_s * speed_m2ps2,
                             by_turn.dot(motion.turn_covariance * by_turn)};
  return covariance.topLeftCorner<2, 2>() + turn * variance_m2.asDiagonal() * turn.transpose();
}

/// Sigma of an object's acceleration across its course: vehicles steer, pedestrians step aside.
double across_mps2(const flow::TrackedObject& object, double speed_mps,
                   const CollisionWarningConfig& config) {
  if (object.object_class == flow::ObjectClass::kPedestrian)
    return config.pedestrian_acceleration_sigma_mps2;
  return speed_mps * config.yaw_rate_sigma_radps;
}

double along_mps2(const flow::TrackedObject& object, const CollisionWarningConfig& config) {
  return object.object_class == flow::ObjectClass::kPedestrian
             ? config.pedestrian_acceleration_sigma_mps2
             : config.acceleration_sigma_mps2;
}

}  // namespace

std::optional<double> road_of(const VehicleState& vehicle) {
  if (std::abs(vehicle.yaw_rate_radps) > kTurnsRadps) return std::nullopt;
  return vehicle.odom_from_base.heading_rad;
}

std::size_t steps_of(const CollisionWarningConfig& config) {
  return static_cast<std::size_t>(std::lround(config.horizon_s / kPredictionStepS)) + 1;
}

PredictedBoxes predict(const VehicleState& vehicle, const CollisionWarningConfig& config) {
  const Pose2 base_from_centre{config.vehicle_centre_ahead_m, 0.0, 0.0};
  const Motion motion{vehicle.speed_mps, vehicle.acceleration_mps2, vehicle.yaw_rate_radps};
  PredictedBoxes boxes;
  for (const Pose2& odom_from_base : path_of(vehicle.odom_from_base, motion, steps_of(config))) {
    const double after_s = kPredictionStepS * static_cast<double>(boxes.size());
    boxes.push_back(
        {{odom_from_base * base_from_centre, config.vehicle_length_m, config.vehicle_width_m},
         drift_m2(config.acceleration_sigma_mps2,
                  std::abs(vehicle.speed_mps) * config.yaw_rate_sigma_radps, after_s,
                  odom_from_base.heading_rad)});
  }
  return boxes;
}

PredictedBoxes predict(const flow::TrackedObject& object, const CourseState& motion,
                       const std::optional<double>& road_rad,
                       const CollisionWarningConfig& config) {
  const bool is_pedestrian = object.object_class == flow::ObjectClass::kPedestrian;
  const Vector2d& place_m = object.position_in_odom_m;
  const Pose2 start{place_m.x(), place_m.y(), motion.course_rad};
  Motion along{motion.speed_mps, motion.acceleration_mps2, motion.yaw_rate_radps};
  if (!is_pedestrian) along.road_rad = road_along(road_rad, motion.course_rad);
  if (along.road_rad) along.yaw_rate_radps = 0.0;
  PredictedBoxes boxes;
  for (const Pose2& there : path_of(start, along, steps_of(config))) {
    const double after_s = kPredictionStepS * static_cast<double>(boxes.size());
    const double heading_rad =
        geometry::wrap_angle(object.heading_in_odom_rad + there.heading_rad - motion.course_rad);
    const Matrix2d known_m2 =
        is_pedestrian ? carried_m2(object.covariance, after_s)
                      : carried_m2(object.covariance, motion, along.road_rad.has_value(), after_s);
    const Matrix2d unknown_m2 =
        drift_m2(along_mps2(object, config), across_mps2(object, motion.speed_mps, config), after_s,
                 there.heading_rad);
    boxes.push_back({{{there.x_m, there.y_m, heading_rad}, object.length_m, object.width_m},
                     known_m2 + unknown_m2});
  }
  return boxes;
}

}  // namespace slammot::collision_warning
