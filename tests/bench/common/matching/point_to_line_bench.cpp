#include "common/matching/point_to_line.hpp"

#include <benchmark/benchmark.h>

#include "tests/bench/common/matching/street_scan.hpp"

namespace slammot::matching {
namespace {

/// A whole match from 10 cm and 0.6 degrees off.
void match_a_scan(benchmark::State& state) {
  const StreetScan scan = scan_in_a_street(static_cast<int>(state.range(0)));
  PointToLineMatcher matcher;
  geometry::Pose2 found;
  for (auto _ : state) {
    found = matcher.match(scan.points, scan.surfels, scan.prior, scan.prior.pose, {})
                .map_from_base.pose;
    benchmark::DoNotOptimize(found);
  }
  state.counters["error_mm"] = error_mm(found, scan.truth);
}
BENCHMARK(match_a_scan)->Arg(181)->Arg(361)->Arg(1081)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace slammot::matching
