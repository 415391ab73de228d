#pragma once

#include <cstdint>
#include <random>
#include <vector>

#include <Eigen/Core>

#include "common/geometry/pose2.hpp"

namespace slammot::joint_posterior {

inline constexpr double kPeriod_s = 0.2;
inline constexpr double kRange_m = 45.0;  ///< Of the sensor, all round.
inline constexpr double kLeastRange_m = 3.0;
inline constexpr double kRangeSigma_m = 0.10;      ///< Of a measured range,
inline constexpr double kBearingSigma_rad = 0.01;  ///< and bearing.
inline constexpr double kSpeedSigma_mps = 0.2;     ///< Of measured speed,
inline constexpr double kTurnSigma_radps = 0.02;   ///< and turn rate of the vehicle.

/// Where an object is and how it moves, in world.
struct PointObject {
  Eigen::Vector2d place_m = Eigen::Vector2d::Zero();
  Eigen::Vector2d velocity_mps = Eigen::Vector2d::Zero();
};

/// Measured motion of the vehicle over one period.
struct Control {
  double speed_mps = 0.0;
  double turn_radps = 0.0;
};

/// (range [m], bearing [rad]) of an object from the vehicle. Whose it is, is known.
struct Observation {
  std::size_t object = 0;  ///< Landmarks first, then movers.
  Eigen::Vector2d range_bearing;
};

/// Pose after one period of motion at constant speed and turn rate.
geometry::Pose2 moved(const geometry::Pose2& world_from_base, const Control& control);

/// A vehicle on a circle among landmarks and movers. Movers change their velocity at random; every
/// second one stands still for a third of the time.
class World {
 public:
  World(std::size_t landmarks, std::size_t movers, std::uint64_t seed);

  /// Moves everything by one period and returns the measured motion.
  Control advance();
  std::vector<Observation> observe();

  const geometry::Pose2& world_from_base() const { return world_from_base_; }
  const std::vector<PointObject>& objects() const { return objects_; }  ///< Landmarks first.
  std::size_t landmarks() const { return landmarks_; }

 private:
  double normal(double sigma) { return sigma * std::normal_distribution<double>()(random_); }
  double uniform(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random_);
  }
  void move(PointObject& object, std::size_t mover);

  std::mt19937_64 random_;
  std::size_t landmarks_;
  std::vector<PointObject> objects_;
  std::vector<Eigen::Vector2d> cruising_mps_;  ///< Velocity of each mover when it does not stand.
  geometry::Pose2 world_from_base_;
  double time_s_ = 0.0;
};

}  // namespace slammot::joint_posterior
