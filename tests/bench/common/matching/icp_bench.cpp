#include "common/matching/icp.hpp"

#include <benchmark/benchmark.h>

#include "tests/bench/common/matching/street_scan.hpp"

namespace slammot::matching {
namespace {

/// As match_a_scan, by the closed-form ICP of the thesis: the baseline, with what it is off by
/// beside its time.
void match_a_scan_by_icp(benchmark::State& state) {
  const StreetScan scan = scan_in_a_street(static_cast<int>(state.range(0)));
  IcpResult found;
  for (auto _ : state) {
    found = match_by_icp(scan.points, scan.surfels, scan.prior.pose, {});
    benchmark::DoNotOptimize(found);
  }
  state.counters["error_mm"] = error_mm(found.map_from_base, scan.truth);
  state.counters["steps"] = found.steps;
}
BENCHMARK(match_a_scan_by_icp)->Arg(181)->Arg(361)->Arg(1081)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace slammot::matching
