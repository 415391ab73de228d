#include "common/simulation/robot.hpp"

#include <algorithm>
#include <cmath>

namespace slammot::simulation {

using geometry::Pose2;
using geometry::Vector2;

Robot::Robot(const std::vector<Vector2>& corners_in_world, const RobotConfig& config)
    : config_(config), path_in_world_(rounded_way(corners_in_world, config.bend_m)) {}

double Robot::wanted_speed_mps(const std::vector<MovingObject>& people) const {
  const Pose2 base_from_world = inverse(world_from_base());
  for (const MovingObject& person : people) {
    const Vector2 in_base = base_from_world * person.world_from_object.translation_m();
    const bool in_the_way =
        in_base.x() > 0.0 && in_base.x() < config_.keep_clear_m && std::abs(in_base.y()) < 0.45;
    if (in_the_way) return 0.0;
  }
  const double left_m = path_in_world_.length_m() - arc_m_;
  const double stopping_mps = std::sqrt(2.0 * config_.acceleration_mps2 * std::max(0.0, left_m));
  const double turn_rad = geometry::wrap_angle(path_in_world_.pose_at(arc_m_ + 0.5).heading_rad -
                                               world_from_base().heading_rad);
  const double cruising_mps =
      std::abs(turn_rad) > 0.05 ? config_.turning_speed_mps : config_.speed_mps;
  return std::min(cruising_mps, stopping_mps);
}

void Robot::advance(double dt_s, const std::vector<MovingObject>& people) {
  const double wanted_mps = wanted_speed_mps(people);
  const double change_mps = config_.acceleration_mps2 * dt_s;
  speed_mps_ += std::clamp(wanted_mps - speed_mps_, -3.0 * change_mps, change_mps);
  arc_m_ = std::min(arc_m_ + speed_mps_ * dt_s, path_in_world_.length_m());
}

}  // namespace slammot::simulation
