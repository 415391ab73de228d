#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "common/simulation/path.hpp"
#include "common/simulation/piecewise_linear.hpp"
#include "common/simulation/random.hpp"
#include "common/simulation/scenario.hpp"
#include "common/simulation/scene.hpp"

namespace slammot::simulation {
namespace {

using geometry::Pose2;
using geometry::Vector2;

constexpr double kStride_m = 1.45;
constexpr double kStep_m = 0.55;

double speed_at(const std::vector<SpeedAt>& profile, double time_s) {
  return piecewise_linear(profile, &SpeedAt::at_s, &SpeedAt::mps, time_s);
}

/// One of the script's objects, or a copy of it.
class Actor {
 public:
  Actor(const ScriptedObject& script, int id, double start_s, Random& random)
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
    if (path_in_world_.length_m() > 0.0)
      speed_mps_ = speed_factor_ * speed_at(script.speed, start_s);
  }

  bool carries_scanner() const { return script_.carries_scanner; }

  void advance(double time_s, double dt_s) {
    if (path_in_world_.length_m() <= 0.0) return;
    speed_mps_ = speed_factor_ * speed_at(script_.speed, time_s);
    const double left_m = path_in_world_.length_m() - ahead_m_;
    if (speed_mps_ * dt_s > left_m) speed_mps_ = 0.0;
    ahead_m_ += speed_mps_ * dt_s;
    phase_rad_ += 2.0 * std::numbers::pi * speed_mps_ * dt_s / kStride_m;
  }

  MovingObject object(double time_s) const {
    MovingObject now = object_;
    now.world_from_object =
        stays_at_ ? *stays_at_ : path_in_world_.pose_at(ahead_m_) * Pose2{0.0, sideways_m_, 0.0};
    now.speed_mps = speed_mps_;
    const bool is_there = time_s >= script_.from_s && time_s < script_.until_s;
    if (is_there && now.kind == ObjectClass::pedestrian) {
      now.outline_in_object =
          pedestrian_outline(phase_rad_, kStep_m * std::min(1.5, speed_mps_ / 1.35));
    } else if (is_there) {
      now.outline_in_object = outline_in_object_;
    }
    return now;
  }

 private:
  ScriptedObject script_;
  double ahead_m_;
  double sideways_m_;
  double speed_factor_;
  double phase_rad_;
  double speed_mps_ = 0.0;
  std::optional<Pose2> stays_at_;
  Path path_in_world_;
  MovingObject object_;
  Outline outline_in_object_;
};

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
  const double phase_rad = 2.0 * std::numbers::pi * time_s * object.speed_mps / kStride_m;
  object.outline_in_object = recorded.kind == ObjectClass::pedestrian
                                 ? pedestrian_outline(phase_rad, kStep_m)
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
      actors_.emplace_back(script, static_cast<int>(actors_.size()), time_s_, random);
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
    for (Actor& actor : actors_) actor.advance(time_s_, dt_s);
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
  bool rides_recorded() const { return recorded_vehicle_ >= 0; }
  MovingObject recorded(int index) const {
    return object_at(recorded_[static_cast<std::size_t>(index)],
                     static_cast<int>(actors_.size()) + 1 + index, time_s_);
  }

  Outline stationary_in_world_;
  double time_s_;
  std::vector<RecordedObject> recorded_;
  int recorded_vehicle_;
  std::vector<Actor> actors_;  ///< The first vehicle first.
  std::size_t ridden_ = 0;
};

}  // namespace

std::unique_ptr<Scene> make_script_scene(const ScenarioConfig& scenario) {
  return std::make_unique<ScriptScene>(scenario);
}

}  // namespace slammot::simulation
