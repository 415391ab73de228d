#include "common/matching/scrim.hpp"

#include <benchmark/benchmark.h>

#include "tests/bench/common/matching/street_scan.hpp"

namespace slammot::matching {
namespace {

/// As match_a_scan, from as many initial guesses as are the default.
void match_a_scan_by_scrim(benchmark::State& state) {
  const StreetScan scan = scan_in_a_street(static_cast<int>(state.range(0)));
  Scrim scrim;
  std::mt19937_64 random(1);
  geometry::Pose2 found;
  for (auto _ : state) {
    found = scrim.match(scan.points, scan.surfels, scan.prior, {}, {}, random).map_from_base.pose;
    benchmark::DoNotOptimize(found);
  }
  state.counters["error_mm"] = error_mm(found, scan.truth);
}
BENCHMARK(match_a_scan_by_scrim)->Arg(181)->Arg(361)->Arg(1081)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace slammot::matching
