#include "common/simulation/script_actor.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "common/simulation/piecewise_linear.hpp"

namespace slammot::simulation {
namespace {

using geometry::Pose2;
using geometry::Vector2;

double speed_at(const std::vector<SpeedAt>& profile, double time_s) {
  return piecewise_linear(profile, &SpeedAt::at_s, &SpeedAt::mps, time_s);
}

Vector2 direction_of(const Pose2& pose) {
  return {std::cos(pose.heading_rad), std::sin(pose.heading_rad)};
}

}  // namespace

ScriptActor::ScriptActor(const ScriptedObject& script, int id, double start_s, Random& random)
    : script_(script),
      ahead_m_(random.uniform(0.0, script.ahead_variation_m)),
      sideways_m_(random.uniform(-script.sideways_variation_m, script.sideways_variation_m)),
      speed_factor_(1.0 + random.uniform(-script.speed_variation, script.speed_variation)),
      phase_rad_(random.uniform(0.0, 2.0 * std::numbers::pi)) {
  std::vector<Vector2> corners;
  for (const PlaceInWorld& place : script.way) corners.push_back({place.x_m, place.y_m});
  if (corners.size() == 1) stays_at_ = Pose2{corners[0].x(), corners[0].y(), script.heading_rad};
  if (corners.size() > 1) path_in_world_ = Path(rounded_way(corners, script.bend_m));
  object_.id = id;
  object_.kind = script.kind;
  object_.size = usual_size(script.kind);
  if (script.length_m > 0.0) object_.size.length_m = script.length_m;
  if (script.width_m > 0.0) object_.size.width_m = script.width_m;
  outline_in_object_ = vehicle_outline(script.kind, object_.size);
  if (path_in_world_.length_m() > 0.0) speed_mps_ = speed_factor_ * speed_at(script.speed, start_s);
}

bool ScriptActor::is_there(double time_s) const {
  return time_s >= script_.from_s && time_s < script_.until_s;
}

void ScriptActor::advance(double time_s, double dt_s) {
  if (path_in_world_.length_m() <= 0.0) return;
  speed_mps_ = scripted_speed_mps(time_s, dt_s);
  ahead_m_ += speed_mps_ * dt_s;
  phase_rad_ += 2.0 * std::numbers::pi * speed_mps_ * dt_s / kPedestrianStride_m;
}

void ScriptActor::walk(double time_s, double dt_s, std::span<const Disc> others,
                       const Outline& stationary) {
  const Vector2 preferred_mps = preferred_velocity_mps(scripted_speed_mps(time_s, dt_s), dt_s);
  const Vector2 velocity_mps =
      velocity_giving_way(disc(time_s, dt_s), preferred_mps, others, stationary, dt_s);
  if (!detour_ && velocity_mps == preferred_mps) {
    advance(time_s, dt_s);
  } else {
    leave_way(velocity_mps, dt_s);
  }
}

MovingObject ScriptActor::object(double time_s) const {
  MovingObject now = object_;
  now.world_from_object = stays_at_ ? *stays_at_ : pose_on_way(ahead_m_);
  if (detour_) {
    const Vector2 place = place_in_world();
    now.world_from_object = {place.x(), place.y(), detour_->heading_rad};
  }
  now.speed_mps = speed_mps_;
  if (!is_there(time_s)) return now;
  now.outline_in_object =
      is_pedestrian()
          ? pedestrian_outline(phase_rad_, kPedestrianStep_m * std::min(1.5, speed_mps_ / 1.35))
          : outline_in_object_;
  return now;
}

Disc ScriptActor::disc(double time_s, double dt_s) const {
  const double mps = scripted_speed_mps(time_s, dt_s);
  const Vector2 velocity_mps = detour_ ? detour_->velocity_in_world_mps
                               : mps > 0.0
                                   ? Vector2(mps * direction_of(path_in_world_.pose_at(ahead_m_)))
                                   : Vector2::Zero();
  return {place_in_world(), velocity_mps, kPedestrianRadius_m, mps > 0.0};
}

Pose2 ScriptActor::pose_on_way(double ahead_m) const {
  return path_in_world_.pose_at(ahead_m) * Pose2{0.0, sideways_m_, 0.0};
}

Vector2 ScriptActor::place_in_world() const {
  if (stays_at_) return stays_at_->translation_m();
  const Vector2 on_way = pose_on_way(ahead_m_).translation_m();
  return detour_ ? Vector2(on_way + detour_->from_way_in_world) : on_way;
}

/// Zero at the end of the way.
double ScriptActor::scripted_speed_mps(double time_s, double dt_s) const {
  if (path_in_world_.length_m() <= 0.0) return 0.0;
  const double mps = speed_factor_ * speed_at(script_.speed, time_s);
  return mps * dt_s > path_in_world_.length_m() - ahead_m_ ? 0.0 : mps;
}

/// Along the way, and back to it.
Vector2 ScriptActor::preferred_velocity_mps(double scripted_mps, double dt_s) const {
  constexpr double kReturn_s = 2.0;
  constexpr double kHurry = 1.2;  // greatest speed on a detour, as a multiple of the script's
  if (scripted_mps <= 0.0) return Vector2::Zero();
  const Vector2 along_mps = (pose_on_way(ahead_m_ + scripted_mps * dt_s).translation_m() -
                             pose_on_way(ahead_m_).translation_m()) /
                            dt_s;
  if (!detour_) return along_mps;
  const Vector2 wanted_mps = along_mps - detour_->from_way_in_world / kReturn_s;
  return wanted_mps * std::min(1.0, kHurry * scripted_mps / std::max(1e-9, wanted_mps.norm()));
}

/// A step away from the way, or back to it. The heading is that of the motion.
void ScriptActor::leave_way(const Vector2& velocity_mps, double dt_s) {
  constexpr double kBack_m = 0.002;   // nearer than this it is on its way again
  constexpr double kTurns_mps = 0.2;  // slower than this it keeps its heading
  const Vector2 next = place_in_world() + velocity_mps * dt_s;
  const Pose2 on_way = pose_on_way(ahead_m_);
  const double progress_m = velocity_mps.dot(direction_of(on_way)) * dt_s;
  ahead_m_ += std::clamp(progress_m, 0.0, path_in_world_.length_m() - ahead_m_);
  speed_mps_ = velocity_mps.norm();
  phase_rad_ += 2.0 * std::numbers::pi * speed_mps_ * dt_s / kPedestrianStride_m;
  const double heading_rad = speed_mps_ > kTurns_mps
                                 ? std::atan2(velocity_mps.y(), velocity_mps.x())
                             : detour_ ? detour_->heading_rad
                                       : on_way.heading_rad;
  detour_ = Detour{next - pose_on_way(ahead_m_).translation_m(), velocity_mps, heading_rad};
  if (detour_->from_way_in_world.norm() < kBack_m) detour_.reset();
}

}  // namespace slammot::simulation
