#pragma once

#include <memory>
#include <vector>

#include "common/simulation/moving_object.hpp"

namespace slammot::simulation {

struct ScenarioConfig;

/// A place with its moving objects, selected by the scenario: the interface that the scanner needs.
class Scene {
 public:
  virtual ~Scene() = default;

  /// Stationary surfaces in the world frame, constant over the drive.
  virtual const Outline& stationary_in_world() const = 0;
  virtual void advance(double dt_s) = 0;
  /// The vehicle that carries the scanners.
  virtual MovingObject vehicle() const = 0;
  /// All other objects that can move, ids from 1 on; the same objects in the same order after every
  /// advance.
  virtual std::vector<MovingObject> others() const = 0;
};

/// Streets with traffic and people.
std::unique_ptr<Scene> make_city_scene(const ScenarioConfig& scenario);
/// A floor of corridors and rooms with a robot and people.
std::unique_ptr<Scene> make_office_scene(const ScenarioConfig& scenario);

/// The scene of the scenario's script.
std::unique_ptr<Scene> make_script_scene(const ScenarioConfig& scenario);

}  // namespace slammot::simulation
