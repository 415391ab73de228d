#include "services/loop_closing/loop_closer.hpp"

#include <benchmark/benchmark.h>

#include "tests/support/ring_drive.hpp"

namespace slammot::loop_closing {
namespace {

/// Every submap of a drive once and a half around a block: searches, closures and optimisations
/// included.
void add_a_submap(benchmark::State& state) {
  const auto submaps = testing::drive(testing::ring(), testing::way_around_the_ring(1.5), 0.002);
  for (auto _ : state) {
    LoopCloser closer(testing::indoor_loop_closing());
    for (const flow::Submap& submap : submaps) benchmark::DoNotOptimize(closer.add(submap));
  }
  state.counters["per_submap"] = benchmark::Counter(
      static_cast<double>(submaps.size()),
      benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}
BENCHMARK(add_a_submap)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace slammot::loop_closing
