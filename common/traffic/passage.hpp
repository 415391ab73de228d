#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "common/geometry/pose2.hpp"

namespace slammot::traffic {

enum class Mover : std::uint8_t { kVehicle, kBicycle, kPedestrian };

constexpr int kMovers = 3;

/// Vehicles and bicycles keep to a direction; a walkway is used in both.
constexpr bool is_directed(Mover mover) { return mover != Mover::kPedestrian; }

/// State of a tracked object at the time of one scan.
struct MoverState {
  std::int64_t stamp_ns = 0;
  geometry::Vector2 position_in_map_m = geometry::Vector2::Zero();  ///< Centre of its box.
  geometry::Vector2 velocity_in_map_mps = geometry::Vector2::Zero();
  Eigen::Matrix4d covariance = Eigen::Matrix4d::Zero();  ///< (x, y [m], vx, vy [m/s]) in map.
};

/// One confirmed track from its beginning to its end: the states in which it had an echo and was
/// reported as moving, with ascending stamps.
struct Passage {
  Mover mover = Mover::kVehicle;
  double width_m = 0.0;  ///< Of the object.
  std::vector<MoverState> states;
};

}  // namespace slammot::traffic
