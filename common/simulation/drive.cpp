#include "common/simulation/drive.hpp"

#include <algorithm>
#include <cmath>
#include <deque>
#include <limits>
#include <utility>

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

ObjectTruth truth_of(const MovingObject& object, const Pose2& world_from_base, int points) {
  const double range_m =
      (object.world_from_object.translation_m() - world_from_base.translation_m()).norm();
  return {object.id,        object.kind, object.size, object.world_from_object,
          object.speed_mps, points,      range_m};
}

/// Fills in objects, unseen and hits.
void tell_truth(const ScannedWorld& scanned, const Moment& moment, SimulatedScan& result) {
  std::vector<int> points(moment.objects.size(), 0);
  for (const int source : scanned.source) {
    if (source >= 0) ++points[static_cast<std::size_t>(source)];
    result.hits.push_back(source >= 0 ? moment.objects[static_cast<std::size_t>(source)].id
                          : source == kStationary ? kHitStationary
                          : source == kNothing    ? kHitNothing
                                                  : kHitSeveral);
  }
  for (std::size_t i = 0; i < points.size(); ++i) {
    const MovingObject& object = moment.objects[i];
    const bool is_there =
        !object.outline_in_object.segments.empty() || !object.outline_in_object.circles.empty();
    if (is_there)
      (points[i] > 0 ? result.objects : result.unseen)
          .push_back(truth_of(object, moment.world_from_base, points[i]));
  }
}

/// Interpolated moment at a fraction of the step.
Moment between(const Moment& before, const Moment& after, double fraction) {
  if (fraction == 0.0) return before;
  Moment moment = before;
  moment.world_from_base = interpolate(before.world_from_base, after.world_from_base, fraction);
  moment.nose_down_rad += fraction * (after.nose_down_rad - before.nose_down_rad);
  for (std::size_t i = 0; i < moment.objects.size(); ++i) {
    MovingObject& object = moment.objects[i];
    object.world_from_object =
        interpolate(object.world_from_object, after.objects[i].world_from_object, fraction);
    object.speed_mps += fraction * (after.objects[i].speed_mps - object.speed_mps);
  }
  return moment;
}

/// The first scanner's noise must not depend on further scanners.
std::uint64_t seed_of_scanner(std::uint64_t seed, std::size_t index) {
  return seed + 0x10001 * index;
}

}  // namespace

struct Drive::World {
  /// Periodic events with their own rate, from the drive's first scan on.
  class Beat {
   public:
    Beat(double rate_hz, double first_s) : rate_hz_(rate_hz), first_s_(first_s) {}

    double due_s() const {
      return rate_hz_ > 0.0 ? first_s_ + static_cast<double>(count_) / rate_hz_
                            : std::numeric_limits<double>::infinity();
    }
    std::uint32_t count() const { return count_; }
    void went() { ++count_; }

   private:
    double rate_hz_;
    double first_s_;
    std::uint32_t count_ = 0;
  };

  struct OneScanner {
    ScannerConfig config;
    Random random;
    Beat beat;
  };

  explicit World(const ScenarioConfig& config)
      : scenario(config),
        scene(make_scene(config)),
        ray_caster(scene->stationary_in_world()),
        suspension(config.suspension),
        odometer(config.odometry, seed()),
        terrain(config.terrain),
        random(config.seed, Purpose::scanner),
        gnss(config.gnss, scene->stationary_in_world(), seed()),
        compass(config.compass, seed()),
        gnss_beat(config.gnss.rate_hz, 0.0),
        compass_beat(config.compass.rate_hz, 0.0),
        gyro(config.imu, seed()),
        imu_beat(config.imu.rate_hz, 0.0),
        step_s(1.0 / config.scanner.rate_hz),
        last_speed_mps(scene->vehicle().speed_mps) {
    for (std::size_t i = 0; i < config.more_scanners.size(); ++i) {
      const ScannerConfig& scanner = config.more_scanners[i];
      more_scanners.push_back({scanner,
                               Random(seed_of_scanner(config.seed, i + 1), Purpose::scanner),
                               Beat(scanner.rate_hz, scanner.delay_s)});
    }
    const auto unrecorded = static_cast<int>(config.warm_up_s / step_s);
    for (int i = 0; i < unrecorded; ++i) advance();
    before = moment();
    odometer = WheelOdometer(config.odometry, seed());  // starts at zero where the recording starts
    scans = static_cast<std::size_t>(std::floor(config.duration_s * config.scanner.rate_hz));
  }

  /// Separate for each vehicle.
  std::uint64_t seed() const { return scenario.seed + static_cast<std::uint64_t>(scenario.ride); }

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

  /// All scans that begin in the next step.
  void record_step() {
    const double now_s = static_cast<double>(recorded) * step_s;
    advance();
    Moment after = moment();
    SimulatedScan first = scan(scenario.scanner, 0.0, after, random);
    stamp(now_s, static_cast<std::uint32_t>(recorded), first);
    first.odometry.wheel_from_base = odometer.wheel_from_base();
    first.odometry_speed_mps = odometer.speed_mps();
    first.odometry_yaw_rate_radps = odometer.yaw_rate_radps();
    add_aids(now_s, first);
    first.turn_rates = std::exchange(turn_rates, {});
    measure_turns(now_s, inverse(before.world_from_base) * after.world_from_base);
    odometer.advance(inverse(before.world_from_base) * after.world_from_base, step_s);
    for (std::size_t i = 0; i < more_scanners.size(); ++i) record_others(i, now_s, after, first);
    ready.push_front(std::move(first));
    std::stable_sort(ready.begin(), ready.end(), [](const auto& a, const auto& b) {
      return a.scan.stamp_ns < b.scan.stamp_ns;
    });
    before = std::move(after);
    ++recorded;
  }

  void record_others(std::size_t index, double now_s, const Moment& after,
                     const SimulatedScan& first) {
    OneScanner& scanner = more_scanners[index];
    for (; scanner.beat.due_s() < now_s + step_s; scanner.beat.went()) {
      const double due_s = std::max(now_s, scanner.beat.due_s());
      SimulatedScan result = scan(scanner.config, due_s - now_s, after, scanner.random);
      stamp(due_s, scanner.beat.count(), result);
      result.scanner = index + 1;
      result.odometry.wheel_from_base = interpolate(
          first.odometry.wheel_from_base, odometer.wheel_from_base(), (due_s - now_s) / step_s);
      result.odometry_speed_mps = first.odometry_speed_mps;
      result.odometry_yaw_rate_radps = first.odometry_yaw_rate_radps;
      ready.push_back(std::move(result));
    }
  }

  SimulatedScan scan(const ScannerConfig& config, double after_s, const Moment& after,
                     Random& noise) const {
    const ScannedWorld scanned =
        scan_world(config, ray_caster, {before, after, step_s, terrain, after_s}, noise);
    const Moment now = between(before, after, after_s / step_s);
    const Pose2 moved = inverse(before.world_from_base) * after.world_from_base;
    SimulatedScan result;
    result.scan = {0, 0, scanner_of(config), scanned.range_m};
    result.is_vertical = scans_vertically(config);
    result.world_from_base = now.world_from_base;
    result.speed_mps = moved.x_m / step_s;
    result.yaw_rate_radps = moved.heading_rad / step_s;
    result.nose_down_rad = now.nose_down_rad;
    tell_truth(scanned, now, result);
    return result;
  }

  void stamp(double after_start_s, std::uint32_t sequence, SimulatedScan& result) const {
    result.scan.stamp_ns = nanoseconds(scenario.start_stamp_s + after_start_s);
    result.scan.sequence = sequence;
    result.odometry.stamp_ns = result.scan.stamp_ns;
  }

  /// Receiver and compass report at the first scan at or after their time.
  void add_aids(double now_s, SimulatedScan& result) {
    const auto moved_m = [&](const std::optional<Pose2>& last) {
      return last ? (before.world_from_base.translation_m() - last->translation_m()).norm() : 0.0;
    };
    if (gnss_beat.due_s() <= now_s) {
      result.gnss.push_back(
          gnss.fix(before.world_from_base, 1.0 / scenario.gnss.rate_hz, moved_m(last_fix_at)));
      result.gnss.back().stamp_ns = result.scan.stamp_ns;
      result.gnss.back().altitude_m += terrain.height_m(before.world_from_base.x_m);
      last_fix_at = before.world_from_base;
    }
    if (compass_beat.due_s() <= now_s) {
      result.compass.push_back(compass.reading(before.world_from_base, moved_m(last_reading_at)));
      result.compass.back().stamp_ns = result.scan.stamp_ns;
      last_reading_at = before.world_from_base;
    }
    while (gnss_beat.due_s() <= now_s) gnss_beat.went();
    while (compass_beat.due_s() <= now_s) compass_beat.went();
  }

  /// Readings after this scan up to the next one, for that one.
  void measure_turns(double now_s, const Pose2& moved) {
    const double yaw_rate_radps = moved.heading_rad / step_s;
    for (; imu_beat.due_s() <= now_s + step_s; imu_beat.went()) {
      turn_rates.push_back(gyro.reading(yaw_rate_radps, 1.0 / scenario.imu.rate_hz));
      turn_rates.back().stamp_ns = nanoseconds(scenario.start_stamp_s + imu_beat.due_s());
    }
  }

  ScenarioConfig scenario;
  std::unique_ptr<Scene> scene;
  RayCaster ray_caster;
  Suspension suspension;
  WheelOdometer odometer;
  Terrain terrain;
  Random random;
  std::vector<OneScanner> more_scanners;
  GnssReceiver gnss;
  Compass compass;
  Beat gnss_beat, compass_beat;
  Gyro gyro;
  Beat imu_beat;
  std::vector<sensing::TurnRate> turn_rates;
  std::optional<Pose2> last_fix_at, last_reading_at;
  double step_s;
  double dive_rad = 0.0;  ///< Pitch by the springs alone, nose down.
  double last_speed_mps;
  Moment before;
  std::size_t scans = 0;
  std::size_t recorded = 0;  ///< Steps.
  std::deque<SimulatedScan> ready;
};

Drive::Drive(const ScenarioConfig& scenario) : world_(std::make_unique<World>(scenario)) {}
Drive::~Drive() = default;
Drive::Drive(Drive&&) noexcept = default;
Drive& Drive::operator=(Drive&&) noexcept = default;

std::optional<SimulatedScan> Drive::next() {
  if (world_->ready.empty()) {
    if (world_->recorded >= world_->scans) return std::nullopt;
    world_->record_step();
  }
  SimulatedScan scan = std::move(world_->ready.front());
  world_->ready.pop_front();
  return scan;
}

const Outline& Drive::stationary_in_world() const { return world_->scene->stationary_in_world(); }
std::size_t Drive::scan_count() const { return world_->scans; }

}  // namespace slammot::simulation
