#include "common/simulation/city_world.hpp"
#include "common/simulation/scenario.hpp"
#include "common/simulation/scene.hpp"

namespace slammot::simulation {
namespace {

class CityScene final : public Scene {
 public:
  explicit CityScene(const ScenarioConfig& config)
      : plan_(config.city, config.seed),
        stationary_in_world_(build_city(plan_, config.seed)),
        traffic_(plan_, {config.traffic, config.route, config.seed}),
        walkers_(pavements(plan_), config.walkers, config.seed) {}

  const Outline& stationary_in_world() const override { return stationary_in_world_; }

  void advance(double dt_s) override {
    traffic_.advance(dt_s, walkers_.on_road());
    walkers_.advance(dt_s, traffic_.street_view());
  }

  MovingObject vehicle() const override { return traffic_.objects().front(); }

  std::vector<MovingObject> others() const override {
    std::vector<MovingObject> objects(traffic_.objects().begin() + 1, traffic_.objects().end());
    const std::vector<MovingObject> people =
        walkers_.objects(static_cast<int>(traffic_.objects().size()));
    objects.insert(objects.end(), people.begin(), people.end());
    return objects;
  }

 private:
  StreetPlan plan_;
  Outline stationary_in_world_;
  Traffic traffic_;
  Walkers walkers_;
};

}  // namespace

std::unique_ptr<Scene> make_city_scene(const ScenarioConfig& scenario) {
  return std::make_unique<CityScene>(scenario);
}

}  // namespace slammot::simulation
