#include "examples/joint_posterior/world.hpp"

#include <cmath>
#include <numbers>

namespace slammot::joint_posterior {
namespace {

constexpr double kSpeed_mps = 5.0;
constexpr double kRadius_m = 25.0;     // Of the vehicle's circle, whose centre is in the middle.
constexpr double kHalfWidth_m = 50.0;  // Of the square of the objects.
constexpr double kWorldAcceleration_mps2 = 0.5;  // Of movers, white, one sigma an axis and period.
constexpr double kReturn_mps2 = 1.0;   // Towards the middle for movers outside the square.
constexpr double kStopCycle_s = 15.0;  // One stop in each, for a third of it.

}  // namespace

geometry::Pose2 moved(const geometry::Pose2& world_from_base, const Control& control) {
  const double turn_rad = control.turn_radps * kPeriod_s;
  const double way_m = control.speed_mps * kPeriod_s;
  const double heading_rad = world_from_base.heading_rad + 0.5 * turn_rad;
  return {world_from_base.x_m + way_m * std::cos(heading_rad),
          world_from_base.y_m + way_m * std::sin(heading_rad),
          geometry::wrap_angle(world_from_base.heading_rad + turn_rad)};
}

World::World(std::size_t landmarks, std::size_t movers, std::uint64_t seed)
    : random_(seed), landmarks_(landmarks) {
  for (std::size_t i = 0; i < landmarks + movers; ++i) {
    PointObject object;
    object.place_m = {uniform(-kHalfWidth_m, kHalfWidth_m),
                      kRadius_m + uniform(-kHalfWidth_m, kHalfWidth_m)};
    if (i >= landmarks) {
      const double course_rad = uniform(-std::numbers::pi, std::numbers::pi);
      object.velocity_mps =
          uniform(1.0, 5.0) * Eigen::Vector2d(std::cos(course_rad), std::sin(course_rad));
      cruising_mps_.push_back(object.velocity_mps);
    }
    objects_.push_back(object);
  }
}

Control World::advance() {
  const Control control{kSpeed_mps, kSpeed_mps / kRadius_m};
  world_from_base_ = moved(world_from_base_, control);
  time_s_ += kPeriod_s;
  for (std::size_t i = landmarks_; i < objects_.size(); ++i) move(objects_[i], i - landmarks_);
  return {control.speed_mps + normal(kSpeedSigma_mps),
          control.turn_radps + normal(kTurnSigma_radps)};
}

void World::move(PointObject& object, std::size_t mover) {
  Eigen::Vector2d& cruising_mps = cruising_mps_[mover];
  const Eigen::Vector2d from_middle_m = object.place_m - Eigen::Vector2d(0.0, kRadius_m);
  Eigen::Vector2d acceleration{normal(kWorldAcceleration_mps2), normal(kWorldAcceleration_mps2)};
  if (from_middle_m.lpNorm<Eigen::Infinity>() > kHalfWidth_m)
    acceleration -= kReturn_mps2 * from_middle_m.normalized();
  const double phase = std::fmod(time_s_ + static_cast<double>(mover), kStopCycle_s) / kStopCycle_s;
  const bool stands = mover % 2 == 1 && phase > 2.0 / 3.0;
  cruising_mps += kPeriod_s * acceleration;
  object.velocity_mps = stands ? Eigen::Vector2d::Zero() : cruising_mps;
  object.place_m += kPeriod_s * object.velocity_mps;
}

std::vector<Observation> World::observe() {
  std::vector<Observation> observations;
  for (std::size_t i = 0; i < objects_.size(); ++i) {
    const Eigen::Vector2d in_base = geometry::inverse(world_from_base_) * objects_[i].place_m;
    if (in_base.norm() > kRange_m || in_base.norm() < kLeastRange_m) continue;
    observations.push_back({i,
                            {in_base.norm() + normal(kRangeSigma_m),
                             std::atan2(in_base.y(), in_base.x()) + normal(kBearingSigma_rad)}});
  }
  return observations;
}

}  // namespace slammot::joint_posterior
