#include "services/localization/localizer.hpp"

#include <benchmark/benchmark.h>

#include "tests/support/localizer_drive.hpp"

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
    slammot::testing::DriveSetup setup{.world = slammot::testing::street(120.0),
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
  state.counters["times_real_time"] = benchmark::Counter(kScanPeriod_s, benchmark::Counter::kIsIterationInvariantRate);
}
BENCHMARK(localize_and_integrate_a_scan)->Unit(benchmark::kMicrosecond);

/// What the service does once a second beside its scans.
void make_a_checkpoint(benchmark::State& state) {
  const Recording& drive = recording();
  Localizer localizer{LocalizerConfig{}};
  for (std::uint32_t scan = 0; scan < 50; ++scan) {
    localizer.add_odometry(drive.odometry[scan]);
    localizer.integrate(all_stationary(*localizer.localize(drive.scans[scan])));
  }
  for (auto _ : state) benchmark::DoNotOptimize(localizer.checkpoint());
}
BENCHMARK(make_a_checkpoint)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace slammot::localization
