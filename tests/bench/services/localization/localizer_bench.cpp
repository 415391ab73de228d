#include "services/localization/localizer.hpp"

#include <algorithm>
#include <chrono>
#include <optional>
#include <vector>

#include <benchmark/benchmark.h>

#include "common/matching/point_to_line.hpp"
#include "common/sensing/deskew.hpp"
#include "common/simulation/drive.hpp"
#include "services/detection/detector.hpp"
#include "services/simulator/scenario_files.hpp"
#include "services/tracking/tracker.hpp"
#include "tests/support/localizer_drive.hpp"
#include "tests/support/percentile.hpp"

namespace slammot::localization {
namespace {

using slammot::testing::all_stationary;
using slammot::testing::SimulatedDrive;

constexpr double kScanPeriod_s = 1.0 / 37.5;
constexpr std::uint32_t kScans = 300;

struct Recording {
  std::vector<sensing::Odometry> odometry;
  std::vector<sensing::LaserScan> scans;
};

/// 64 m of a street at 8 m/s with a scanner like an LMS291: 361 beams, 37.5 scans a second.
const Recording& recording() {
  static const Recording one = [] {
    slammot::testing::DriveSetup setup{
        .world = slammot::testing::street(120.0),
        .world_from_base_at = slammot::testing::arc({2.0, -1.0, 0.02}, 8.0, 0.0)};
    setup.scan_period_s = kScanPeriod_s;
    setup.beams = 361;
    setup.scanner = slammot::testing::half_circle_scanner(80.0);
    setup.scanner.beam_step_rad *= 0.5;
    setup.scanner.sweep_s = 1.0 / 75.0;
    setup.wheels = {.scale = 1.01};
    SimulatedDrive drive(setup);
    Recording made;
    for (std::uint32_t scan = 0; scan < kScans; ++scan) {
      made.odometry.push_back(drive.odometry(scan));
      made.scans.push_back(drive.scan(scan));
    }
    return made;
  }();
  return one;
}

/// Everything that localization does with a scan: predict, deskew, match, cast the map, integrate.
void localize_and_integrate_a_scan(benchmark::State& state) {
  const Recording& drive = recording();
  Localizer localizer{LocalizerConfig{}};
  std::uint32_t next = 0;
  for (auto _ : state) {
    if (next == kScans) {
      state.PauseTiming();
      localizer = Localizer{LocalizerConfig{}};
      next = 0;
      state.ResumeTiming();
    }
    localizer.add_odometry(drive.odometry[next]);
    const auto localized = localizer.localize(drive.scans[next]);
    localizer.integrate(all_stationary(*localized));
    ++next;
  }
  state.counters["times_real_time"] =
      benchmark::Counter(kScanPeriod_s, benchmark::Counter::kIsIterationInvariantRate);
}
BENCHMARK(localize_and_integrate_a_scan)->Unit(benchmark::kMicrosecond);

/// Scans, maps and predictions as they are on a drive through a city in traffic: half a minute of
/// the scenario "block" goes through localization, detection and tracking; of each scan of what
/// follows the match against the map as it then is is timed, from where the wheels say that it is.
/// Wanted: p50 of 60 us, as for 361 beams on one core.
void deskew_and_match_in_a_city(benchmark::State& state) {
  constexpr int kScansBefore = 30 * 75 / 2;
  simulation::Drive drive(*simulator::load_scenario("block"));
  const LocalizerConfig config;
  Localizer localizer{config};
  tracking::Tracker tracker{{}};
  matching::PointToLineMatcher matcher;
  std::vector<geometry::Vector2> points_in_base_m;
  std::vector<matching::MatchPoint> points;
  std::vector<double> times_us;
  flow::LocalizedScan last;
  geometry::Pose2 last_wheel_from_base;
  const auto match = [&](const simulation::SimulatedScan& now) {
    const geometry::Pose2 step =
        geometry::inverse(last_wheel_from_base) * now.odometry.wheel_from_base;
    const geometry::UncertainPose2 prior{
        last.odom_from_base.pose * step,
        last.odom_from_base.covariance +
            geometry::Matrix3(Eigen::Vector3d(1e-5, 1e-5, 1e-6).asDiagonal())};
    const auto start = std::chrono::steady_clock::now();
    sensing::deskew(now.scan, last.speed_mps, last.yaw_rate_radps, points_in_base_m);
    points.clear();
    for (std::size_t beam = 0; beam < now.scan.range_m.size(); ++beam) {
      const float range_m = now.scan.range_m[beam];
      if (sensing::is_echo(range_m,
                           std::min(config.echoes.match_range_m, now.scan.scanner.max_range_m)))
        points.push_back({points_in_base_m[beam],
                          config.echoes.range_noise_m + 0.001 * static_cast<double>(range_m)});
    }
    benchmark::DoNotOptimize(
        matcher.match(points, localizer.local_map().surfels(), prior, prior.pose, config.match));
    times_us.push_back(
        std::chrono::duration<double, std::micro>(std::chrono::steady_clock::now() - start)
            .count());
  };
  int scans = 0;
  const auto go_on = [&](bool is_timed) {
    std::optional<simulation::SimulatedScan> now = drive.next();
    if (!now) return false;
    if (is_timed) match(*now);
    localizer.add_odometry(now->odometry);
    const auto localized = localizer.localize(now->scan);
    const tracking::TrackingResult tracked = tracker.step(detection::detect(*localized, {}));
    localizer.expect(tracked.objects);
    localizer.integrate(tracked.labels);
    last = *localized;
    last_wheel_from_base = now->odometry.wheel_from_base;
    ++scans;
    return true;
  };
  while (scans < kScansBefore && go_on(false)) {}
  for (auto _ : state) {
    if (!go_on(true)) {
      state.SkipWithError("the drive is over");
      break;
    }
    state.SetIterationTime(1e-6 * times_us.back());
  }
  state.counters["p50_us"] = testing::percentile(times_us, 0.5);
  state.counters["p99_us"] = testing::percentile(times_us, 0.99);
}
BENCHMARK(deskew_and_match_in_a_city)
    ->UseManualTime()
    ->Iterations(2000)
    ->Unit(benchmark::kMicrosecond);

Localizer localizer_after_50_scans() {
  const Recording& drive = recording();
  Localizer localizer{LocalizerConfig{}};
  for (std::uint32_t scan = 0; scan < 50; ++scan) {
    localizer.add_odometry(drive.odometry[scan]);
    localizer.integrate(all_stationary(*localizer.localize(drive.scans[scan])));
  }
  return localizer;
}

/// What the service does once a second between two scans,
void snapshot_a_localizer(benchmark::State& state) {
  const Localizer localizer = localizer_after_50_scans();
  LocalizerSnapshot snapshot = *localizer.snapshot();
  for (auto _ : state) snapshot = *localizer.snapshot(std::move(snapshot.map));
}
BENCHMARK(snapshot_a_localizer)->Unit(benchmark::kMillisecond);

/// and another thread of it makes of that.
void make_a_checkpoint(benchmark::State& state) {
  const Localizer localizer = localizer_after_50_scans();
  for (auto _ : state) benchmark::DoNotOptimize(localizer.checkpoint());
}
BENCHMARK(make_a_checkpoint)->Unit(benchmark::kMillisecond);

/// What a standby does before its first scan.
void restore_a_localizer(benchmark::State& state) {
  const std::vector<std::byte> checkpoint = localizer_after_50_scans().checkpoint();
  for (auto _ : state) {
    state.PauseTiming();
    Localizer localizer{LocalizerConfig{}};
    state.ResumeTiming();
    if (!localizer.restore(checkpoint)) state.SkipWithError("the checkpoint is not taken");
  }
}
BENCHMARK(restore_a_localizer)->Unit(benchmark::kMillisecond);

void make_a_localizer(benchmark::State& state) {
  for (auto _ : state) benchmark::DoNotOptimize(Localizer{LocalizerConfig{}});
}
BENCHMARK(make_a_localizer)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace slammot::localization
