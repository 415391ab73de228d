#include "common/simulation/drive.hpp"

#include <cmath>
#include <map>

#include "common/simulation/scene.hpp"

namespace slammot::simulation {
namespace {

using geometry::Pose2;

std::unique_ptr<Scene> make_scene(const ScenarioConfig& scenario) {
  switch (scenario.place) {
    case Place::city: return make_city_scene(scenario);
    case Place::office: return make_office_scene(scenario);
    case Place::script: break;
  }
  return make_script_scene(scenario);
}

std::int64_t nanoseconds(double seconds) { return std::llround(seconds * 1e9); }

std::vector<ObjectTruth> objects_hit(const ScannedWorld& scanned, const Moment& moment) {
  std::map<int, int> points;  // by index of the object
  for (const int source : scanned.source) {
    if (source >= 0) ++points[source];
  }
  std::vector<ObjectTruth> truth;
  for (const auto& [index, count] : points) {
    const MovingObject& object = moment.objects[static_cast<std::size_t>(index)];
    const double range_m =
        (object.world_from_object.translation_m() - moment.world_from_base.translation_m()).norm();
    truth.push_back({object.id, object.kind, object.size, object.world_from_object, object.speed_mps, count, range_m});
  }
  return truth;
}

}  // namespace

struct Drive::World {
  explicit World(const ScenarioConfig& config)
      : scenario(config),
        scene(make_scene(config)),
        ray_caster(scene->stationary_in_world()),
        suspension(config.suspension),
        odometer(config.odometry, config.seed + static_cast<std::uint64_t>(config.ride)),
        terrain(config.terrain),
        random(config.seed, Purpose::scanner),
        step_s(1.0 / config.scanner.rate_hz),
        last_speed_mps(scene->vehicle().speed_mps) {
    const auto unrecorded = static_cast<int>(config.warm_up_s / step_s);
    for (int i = 0; i < unrecorded; ++i) advance();
    before = moment();
    odometer = WheelOdometer(config.odometry, config.seed + static_cast<std::uint64_t>(config.ride));  // starts at zero where the recording starts
    scans = static_cast<std::size_t>(std::floor(config.duration_s * config.scanner.rate_hz));
  }

  void advance() {
    scene->advance(step_s);
    const double speed_mps = scene->vehicle().speed_mps;
    dive_rad = suspension.advance((speed_mps - last_speed_mps) / step_s, step_s);
    last_speed_mps = speed_mps;
  }

  Moment moment() const {
    const Pose2 world_from_base = scene->vehicle().world_from_object;
    return {world_from_base, dive_rad + terrain.nose_down_rad(world_from_base), scene->others()};
  }

  SimulatedScan record() {
    advance();
    Moment after = moment();
    const ScannedWorld scanned = scan_world(scenario.scanner, ray_caster, {before, after, step_s, terrain}, random);
    SimulatedScan result;
    const std::int64_t stamp_ns = nanoseconds(scenario.start_stamp_s + static_cast<double>(recorded) * step_s);
    result.scan = {stamp_ns, static_cast<std::uint32_t>(recorded), scanner_of(scenario.scanner), scanned.range_m};
    result.odometry = {stamp_ns, odometer.wheel_from_base()};
    result.odometry_speed_mps = odometer.speed_mps();
    result.odometry_yaw_rate_radps = odometer.yaw_rate_radps();
    result.world_from_base = before.world_from_base;
    result.objects = objects_hit(scanned, before);
    odometer.advance(inverse(before.world_from_base) * after.world_from_base, step_s);
    before = std::move(after);
    ++recorded;
    return result;
  }

  ScenarioConfig scenario;
  std::unique_ptr<Scene> scene;
  RayCaster ray_caster;
  Suspension suspension;
  WheelOdometer odometer;
  Terrain terrain;
  Random random;
  double step_s;
  double dive_rad = 0.0;              ///< Nose down, by the springs alone.
  double last_speed_mps;
  Moment before;
  std::size_t scans = 0;
  std::size_t recorded = 0;
};

Drive::Drive(const ScenarioConfig& scenario) : world_(std::make_unique<World>(scenario)) {}
Drive::~Drive() = default;
Drive::Drive(Drive&&) noexcept = default;
Drive& Drive::operator=(Drive&&) noexcept = default;

std::optional<SimulatedScan> Drive::next() {
  if (world_->recorded >= world_->scans) return std::nullopt;
  return world_->record();
}

const Outline& Drive::stationary_in_world() const { return world_->scene->stationary_in_world(); }
std::size_t Drive::scan_count() const { return world_->scans; }

}  // namespace slammot::simulation
