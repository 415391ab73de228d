#pragma once

#include <optional>
#include <span>

#include "common/simulation/giving_way.hpp"
#include "common/simulation/moving_object.hpp"
#include "common/simulation/path.hpp"
#include "common/simulation/random.hpp"
#include "common/simulation/script.hpp"

namespace slammot::simulation {

/// One of the script's objects, or a copy of it.
class ScriptActor {
 public:
  ScriptActor(const ScriptedObject& script, int id, double start_s, Random& random);

  bool carries_scanner() const { return script_.carries_scanner; }
  bool is_pedestrian() const { return object_.kind == ObjectClass::pedestrian; }
  bool is_there(double time_s) const;

  /// Follows the script.
  void advance(double time_s, double dt_s);
  /// Likewise, but gives way to pedestrians and to what stands. Where nothing is in the way, as
  /// `advance`.
  void walk(double time_s, double dt_s, std::span<const Disc> others, const Outline& stationary);

  MovingObject object(double time_s) const;
  /// The actor as pedestrians see it who step from time_s on.
  Disc disc(double time_s, double dt_s) const;

 private:
  /// Difference to the script of a pedestrian who gives way.
  struct Detour {
    geometry::Vector2 from_way_in_world = geometry::Vector2::Zero();
    geometry::Vector2 velocity_in_world_mps = geometry::Vector2::Zero();
    double heading_rad = 0.0;
  };

  geometry::Pose2 pose_on_way(double ahead_m) const;
  geometry::Vector2 place_in_world() const;
  double scripted_speed_mps(double time_s, double dt_s) const;
  geometry::Vector2 preferred_velocity_mps(double scripted_mps, double dt_s) const;
  void leave_way(const geometry::Vector2& velocity_mps, double dt_s);

  ScriptedObject script_;
  double ahead_m_;
  double sideways_m_;
  double speed_factor_;
  double phase_rad_;
  double speed_mps_ = 0.0;
  std::optional<geometry::Pose2> stays_at_;
  std::optional<Detour> detour_;
  Path path_in_world_;
  MovingObject object_;
  Outline outline_in_object_;
};

}  // namespace slammot::simulation
