#pragma once

#include <vector>

#include "common/simulation/moving_object.hpp"
#include "common/simulation/path.hpp"

namespace slammot::simulation {

struct RobotConfig {
  double speed_mps = 0.6;
  double turning_speed_mps = 0.3;  ///< In bends.
  double acceleration_mps2 = 0.5;
  double bend_m = 0.8;  ///< From where it leaves the straight to the corner.
  double diameter_m = 0.5;
  double keep_clear_m = 1.2;  ///< Stops for pedestrians ahead within this distance.
};

/// A small robot that follows a way of straight pieces with rounded corners and stops for people.
class Robot {
 public:
  Robot(const std::vector<geometry::Vector2>& corners_in_world, const RobotConfig& config);

  void advance(double dt_s, const std::vector<MovingObject>& people);
  geometry::Pose2 world_from_base() const { return path_in_world_.pose_at(arc_m_); }
  double speed_mps() const { return speed_mps_; }

 private:
  double wanted_speed_mps(const std::vector<MovingObject>& people) const;

  RobotConfig config_;
  Path path_in_world_;
  double arc_m_ = 0.0;
  double speed_mps_ = 0.0;
};

}  // namespace slammot::simulation
