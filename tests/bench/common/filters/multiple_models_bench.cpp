// One scan of one object: predict and update by two models. What the IMM costs beside the
// estimators that the thesis holds it against (their errors are in
// tests/unit/common/filters/gpb_test.cpp), and what the stop hypothesis adds.
#include <array>

#include <benchmark/benchmark.h>

#include "common/filters/gpb.hpp"
#include "common/filters/imm.hpp"
#include "common/filters/move_stop.hpp"
#include "tests/support/maneuvers.hpp"

namespace slammot::filters {
namespace {

using testing::velocity_and_acceleration;

const PositionFix kFix{testing::kManeuverPeriodS, {0.4, -0.2}, testing::maneuver_noise_m2()};

void imm_cycle(benchmark::State& state) {
  const ModelSet set = velocity_and_acceleration();
  const ImmState before = imm_start(set, testing::start_of(testing::standing));
  for (auto _ : state)
    benchmark::DoNotOptimize(
        imm_update(set, imm_predict(set, before, kFix.after_s), kFix.position_m, kFix.R));
}
BENCHMARK(imm_cycle)->Unit(benchmark::kMicrosecond);

void imm_path(benchmark::State& state) {  // three seconds ahead, as it is published
  const ModelSet set = velocity_and_acceleration();
  const ImmState now = imm_start(set, testing::start_of(testing::cruising));
  std::array<Gaussian<2>, 6> path;
  for (auto _ : state) {
    imm_foretell(set, now, 0.5, path);
    benchmark::DoNotOptimize(path);
  }
}
BENCHMARK(imm_path)->Unit(benchmark::kMicrosecond);

void gpb1_cycle(benchmark::State& state) {
  const ModelSet set = velocity_and_acceleration();
  const Gpb1State before = gpb1_start(set, testing::start_of(testing::standing));
  for (auto _ : state) benchmark::DoNotOptimize(gpb1_step(set, before, kFix));
}
BENCHMARK(gpb1_cycle)->Unit(benchmark::kMicrosecond);

void gpb2_cycle(benchmark::State& state) {
  const ModelSet set = velocity_and_acceleration();
  const ImmState before = imm_start(set, testing::start_of(testing::standing));
  for (auto _ : state) benchmark::DoNotOptimize(gpb2_step(set, before, kFix));
}
BENCHMARK(gpb2_cycle)->Unit(benchmark::kMicrosecond);

void move_stop_scan(benchmark::State& state) {
  const MotionState moving = testing::start_of(testing::standing);
  MoveStop hypotheses;
  for (auto _ : state)
    benchmark::DoNotOptimize(
        hypotheses = weigh(hypotheses, {moving, kFix.position_m, kFix.after_s}, {0.5, 2.0}));
}
BENCHMARK(move_stop_scan)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace slammot::filters
