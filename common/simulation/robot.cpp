#include "common/simulation/robot.hpp"

#include <algorithm>
#include <cmath>

namespace slammot::simulation {
namespace {

using geometry::Pose2;
using geometry::Vector2;

std::vector<Vector2> rounded(const std::vector<Vector2>& corners, double bend_m) {
  std::vector<Vector2> points{corners.front()};
  const auto extend = [&points](const std::vector<Vector2>& more) { points.insert(points.end(), more.begin() + 1, more.end()); };
  for (std::size_t i = 1; i + 1 < corners.size(); ++i) {
    const Vector2 in = (corners[i] - corners[i - 1]).normalized();
    const Vector2 out = (corners[i + 1] - corners[i]).normalized();
    const Vector2 enter = corners[i] - bend_m * in;
    const Vector2 leave = corners[i] + bend_m * out;
    extend(line(points.back(), enter, 0.2));
    if (in.dot(out) > 0.999) {
      extend(line(enter, leave, 0.2));
    } else {
      extend(bezier(enter, enter + 0.55 * bend_m * in, leave - 0.55 * bend_m * out, leave, 0.02));
    }
  }
  extend(line(points.back(), corners.back(), 0.2));
  return points;
}

}  // namespace

Robot::Robot(const std::vector<Vector2>& corners_in_world, const RobotConfig& config)
    : config_(config), path_in_world_(rounded(corners_in_world, config.bend_m)) {}

double Robot::wanted_speed_mps(const std::vector<MovingObject>& people) const {
  const Pose2 base_from_world = inverse(world_from_base());
  for (const MovingObject& person : people) {
    const Vector2 in_base = base_from_world * person.world_from_object.translation_m();
    const bool in_the_way = in_base.x() > 0.0 && in_base.x() < config_.keep_clear_m && std::abs(in_base.y()) < 0.45;
    if (in_the_way) return 0.0;
  }
  const double left_m = path_in_world_.length_m() - arc_m_;
  const double stopping_mps = std::sqrt(2.0 * config_.acceleration_mps2 * std::max(0.0, left_m));
  const double turn_rad = geometry::wrap_angle(path_in_world_.pose_at(arc_m_ + 0.5).heading_rad - world_from_base().heading_rad);
  const double cruising_mps = std::abs(turn_rad) > 0.05 ? config_.turning_speed_mps : config_.speed_mps;
  return std::min(cruising_mps, stopping_mps);
}

void Robot::advance(double dt_s, const std::vector<MovingObject>& people) {
  const double wanted_mps = wanted_speed_mps(people);
  const double change_mps = config_.acceleration_mps2 * dt_s;
  speed_mps_ += std::clamp(wanted_mps - speed_mps_, -3.0 * change_mps, change_mps);
  arc_m_ = std::min(arc_m_ + speed_mps_ * dt_s, path_in_world_.length_m());
}

}  // namespace slammot::simulation
