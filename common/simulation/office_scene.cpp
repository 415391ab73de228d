#include <cmath>

#include "common/simulation/robot.hpp"
#include "common/simulation/scenario.hpp"
#include "common/simulation/scene.hpp"

namespace slammot::simulation {
namespace {

using geometry::Vector2;

std::vector<Vector2> way_through(const OfficePlan& plan, const std::vector<OfficeCorner>& corners) {
  std::vector<Vector2> way;
  for (const OfficeCorner& corner : corners) way.push_back(plan.corner_in_world(corner));
  return way;
}

class OfficeScene final : public Scene {
 public:
  explicit OfficeScene(const ScenarioConfig& config)
      : plan_(build_office(config.office, config.seed)),
        robot_config_(config.robot),
        robot_(way_through(plan_, config.robot_way), config.robot),
        walkers_(plan_.corridors, config.walkers, config.seed) {}

  const Outline& stationary_in_world() const override { return plan_.outline_in_world; }

  void advance(double dt_s) override {
    robot_.advance(dt_s, walkers_.objects(1));
    walkers_.advance(
        dt_s, {[](const Crossing&) { return true; },
               [this](const Vector2& place_in_world) { return is_too_near(place_in_world); }});
  }

  MovingObject vehicle() const override {
    MovingObject robot;
    robot.size = {robot_config_.diameter_m, robot_config_.diameter_m};
    robot.world_from_object = robot_.world_from_base();
    robot.speed_mps = robot_.speed_mps();
    return robot;
  }

  std::vector<MovingObject> others() const override { return walkers_.objects(1); }

 private:
  bool is_too_near(const Vector2& place_in_world) const {
    const double clear_m = 0.5 * robot_config_.diameter_m + 0.35;
    return (place_in_world - robot_.world_from_base().translation_m()).norm() < clear_m;
  }

  OfficePlan plan_;
  RobotConfig robot_config_;
  Robot robot_;
  Walkers walkers_;
};

}  // namespace

std::unique_ptr<Scene> make_office_scene(const ScenarioConfig& scenario) {
  return std::make_unique<OfficeScene>(scenario);
}

}  // namespace slammot::simulation
