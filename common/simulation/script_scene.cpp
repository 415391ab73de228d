#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <span>

#include "common/simulation/giving_way.hpp"
#include "common/simulation/random.hpp"
#include "common/simulation/scenario.hpp"
#include "common/simulation/scene.hpp"
#include "common/simulation/script_actor.hpp"

namespace slammot::simulation {
namespace {

using geometry::Pose2;
using geometry::Vector2;

/// An object that moves uniformly between recorded places.
MovingObject object_at(const RecordedObject& recorded, int id, double time_s) {
  const auto& places = recorded.places;
  const auto after = std::find_if(places.begin(), places.end(),
                                  [&](const RecordedPlace& place) { return place.at_s > time_s; });
  const RecordedPlace& last = after == places.begin() ? places.front() : *(after - 1);
  const bool is_there = after != places.begin() && (after != places.end() || last.at_s == time_s);
  MovingObject object;
  object.id = id;
  object.kind = recorded.kind;
  object.size = usual_size(recorded.kind);
  object.world_from_object = last.world_from_object;
  object.speed_mps = is_there ? last.speed_mps : 0.0;
  if (!is_there) return object;
  if (after != places.end()) {
    const double fraction = (time_s - last.at_s) / (after->at_s - last.at_s);
    object.world_from_object =
        interpolate(last.world_from_object, after->world_from_object, fraction);
    object.speed_mps += fraction * (after->speed_mps - last.speed_mps);
  }
  const double phase_rad = 2.0 * std::numbers::pi * time_s * object.speed_mps / kPedestrianStride_m;
  object.outline_in_object = recorded.kind == ObjectClass::pedestrian
                                 ? pedestrian_outline(phase_rad, kPedestrianStep_m)
                                 : vehicle_outline(recorded.kind, object.size);
  return object;
}

class ScriptScene final : public Scene {
 public:
  explicit ScriptScene(const ScenarioConfig& config)
      : stationary_in_world_(build_script(config.script, config.seed)),
        time_s_(-config.warm_up_s),
        recorded_(config.script.recorded),
        recorded_vehicle_(config.script.recorded_vehicle) {
    Random random(config.seed, Purpose::traffic);
    std::vector<std::size_t> vehicles;
    const auto add = [&](const ScriptedObject& script) {
      if (script.carries_scanner || &script == &config.script.vehicle)
        vehicles.push_back(actors_.size());
      actors_.push_back(placed(script, random));
    };
    if (!rides_recorded()) add(config.script.vehicle);
    for (const ScriptedObject& script : config.script.objects) {
      for (int i = 0; i < script.copies; ++i) add(script);
    }
    if (!rides_recorded())
      ridden_ = vehicles[std::min(vehicles.size() - 1, static_cast<std::size_t>(config.ride))];
  }

  const Outline& stationary_in_world() const override { return stationary_in_world_; }

  void advance(double dt_s) override {
    const std::vector<Walker> walkers = walkers_now(dt_s);
    for (ScriptActor& actor : actors_) {
      if (actor.is_pedestrian() && actor.is_there(time_s_)) {
        actor.walk(time_s_, dt_s, others_than(actor, walkers), stationary_in_world_);
      } else {
        actor.advance(time_s_, dt_s);
      }
    }
    time_s_ += dt_s;
  }

  MovingObject vehicle() const override {
    return rides_recorded() ? recorded(recorded_vehicle_) : actors_[ridden_].object(time_s_);
  }

  std::vector<MovingObject> others() const override {
    std::vector<MovingObject> objects;
    for (std::size_t i = 0; i < actors_.size(); ++i) {
      if (i == ridden_ && !rides_recorded()) continue;
      objects.push_back(actors_[i].object(time_s_));
      if (i == 0)
        objects.back().id = static_cast<int>(actors_.size());  // the first vehicle, as seen from
                                                               // another one
    }
    for (int i = 0; i < static_cast<int>(recorded_.size()); ++i) {
      if (i != recorded_vehicle_) objects.push_back(recorded(i));
    }
    return objects;
  }

 private:
  struct Walker {
    const ScriptActor* actor;
    Disc disc;
  };

  /// All pedestrians before the step.
  std::vector<Walker> walkers_now(double dt_s) const {
    std::vector<Walker> walkers;
    for (const ScriptActor& actor : actors_) {
      if (actor.is_pedestrian() && actor.is_there(time_s_))
        walkers.push_back({&actor, actor.disc(time_s_, dt_s)});
    }
    return walkers;
  }

  /// What a pedestrian gives way to, but for walls.
  std::vector<Disc> others_than(const ScriptActor& actor,
                                const std::vector<Walker>& walkers) const {
    std::vector<Disc> others;
    for (const Walker& walker : walkers) {
      if (walker.actor != &actor) others.push_back(walker.disc);
    }
    for (const Circle& circle : stationary_in_world_.circles)
      others.push_back({circle.centre, Vector2::Zero(), circle.radius_m, false});
    return others;
  }

  /// A copy of a pedestrian is placed again where it would stand in another.
  ScriptActor placed(const ScriptedObject& script, Random& random) const {
    constexpr int kMostTries = 100;
    for (int i = 0;; ++i) {
      ScriptActor actor(script, static_cast<int>(actors_.size()), time_s_, random);
      if (i == kMostTries || script.copies == 1 || !stands_in_another(actor)) return actor;
    }
  }
  bool stands_in_another(const ScriptActor& actor) const {
    return actor.is_pedestrian() &&
           std::any_of(actors_.begin(), actors_.end(), [&](const ScriptActor& other) {
             return other.is_pedestrian() && distance_m(actor, other) < 2.0 * kPedestrianRadius_m;
           });
  }
  static double distance_m(const ScriptActor& a, const ScriptActor& b) {
    return (a.disc(0.0, 0.0).centre_in_world - b.disc(0.0, 0.0).centre_in_world).norm();
  }

  bool rides_recorded() const { return recorded_vehicle_ >= 0; }
  MovingObject recorded(int index) const {
    return object_at(recorded_[static_cast<std::size_t>(index)],
                     static_cast<int>(actors_.size()) + 1 + index, time_s_);
  }

  Outline stationary_in_world_;
  double time_s_;
  std::vector<RecordedObject> recorded_;
  int recorded_vehicle_;
  std::vector<ScriptActor> actors_;  ///< The first vehicle first.
  std::size_t ridden_ = 0;
};

}  // namespace

std::unique_ptr<Scene> make_script_scene(const ScenarioConfig& scenario) {
  return std::make_unique<ScriptScene>(scenario);
}

}  // namespace slammot::simulation
