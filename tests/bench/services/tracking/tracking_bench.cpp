// Detection and tracking of a street full of movers. Wanted: p50 of 80 us + 100 us for 20 objects
// on one core, p99 of 1 ms for them and of 5 ms for 100. All of them are as old as one another
// here, and so are checked in the same scans: the worst case.
#include <benchmark/benchmark.h>

#include <chrono>
#include <cmath>
#include <utility>
#include <vector>

#include "services/detection/detector.hpp"
#include "services/tracking/tracker.hpp"
#include "tests/support/percentile.hpp"
#include "tests/support/street.hpp"

namespace slammot {
namespace {

flow::LocalizedScan scan_of_traffic(int movers, int step) {
  testing::Street street{{{{60.0, 0.0, 0.0}, 1.0, 120.0}}, {}, {}};
  for (int i = 0; i < movers; ++i) {
    const double bearing_rad = -1.3 + 2.6 * (i + 0.5) / movers;
    const double range_m = 8.0 + 3.0 * (i % 7) + 0.1 * step;
    street.unknown.push_back(
        {{range_m * std::cos(bearing_rad), range_m * std::sin(bearing_rad), bearing_rad},
         i % 2 ? 4.5 : 0.5,
         i % 2 ? 1.8 : 0.5});
  }
  return street.scan(static_cast<std::int64_t>(step * 26'666'667LL),
                     static_cast<std::uint32_t>(step));
}

void detect_traffic(benchmark::State& state) {
  const flow::LocalizedScan scan = scan_of_traffic(static_cast<int>(state.range(0)), 0);
  detection::Detector detector{{}};
  flow::SegmentedScan segmented;
  for (auto _ : state) {
    segmented = detector.detect(scan, std::move(segmented));
    benchmark::DoNotOptimize(segmented);
  }
}
BENCHMARK(detect_traffic)->Arg(0)->Arg(20)->Arg(100)->Unit(benchmark::kMicrosecond);

void track_traffic(benchmark::State& state) {
  std::vector<flow::SegmentedScan> scans;
  for (int step = 0; step < 60; ++step)
    scans.push_back(detection::detect(scan_of_traffic(static_cast<int>(state.range(0)), step), {}));
  std::size_t next = scans.size();
  tracking::Tracker tracker{{}};
  std::vector<double> times_us;
  for (auto _ : state) {
    if (next == scans.size()) {
      state.PauseTiming();
      tracker = tracking::Tracker{{}};
      for (next = 0; next < 20; ++next) tracker.step(scans[next]);  // until they are confirmed
      state.ResumeTiming();
    }
    const auto start = std::chrono::steady_clock::now();
    benchmark::DoNotOptimize(tracker.step(scans[next++]).objects.objects.data());
    times_us.push_back(
        std::chrono::duration<double, std::micro>(std::chrono::steady_clock::now() - start)
            .count());
  }
  state.counters["p50_us"] = testing::percentile(times_us, 0.5);
  state.counters["p99_us"] = testing::percentile(times_us, 0.99);
}
BENCHMARK(track_traffic)->Arg(0)->Arg(20)->Arg(100)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace slammot
