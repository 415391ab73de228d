#pragma once

#include <memory>
#include <vector>

#include "common/simulation/moving_object.hpp"

namespace slammot::simulation {

struct ScenarioConfig;

/// A place with everything that happens in it; the scenario selects which. The scanner only needs this much of it.
class Scene {
 public:
  virtual ~Scene() = default;

  /// Everything that never moves, in the world frame. The same for the whole drive.
  virtual const Outline& stationary_in_world() const = 0;
  virtual void advance(double dt_s) = 0;
  /// The vehicle that carries the scanners.
  virtual MovingObject vehicle() const = 0;
  /// Everything else that moves or could, ids from 1 on; the same objects in the same order after every advance.
  virtual std::vector<MovingObject> others() const = 0;
};

/// Streets with traffic and people.
std::unique_ptr<Scene> make_city_scene(const ScenarioConfig& scenario);
/// A floor of corridors and rooms with a robot and people.
std::unique_ptr<Scene> make_office_scene(const ScenarioConfig& scenario);

/// What the scenario's script says.
std::unique_ptr<Scene> make_script_scene(const ScenarioConfig& scenario);

}  // namespace slammot::simulation
