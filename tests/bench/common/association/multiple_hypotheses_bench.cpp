// One scan of points that stand in rows 3 m apart, `neighbours` of them 0.4 m apart in each: what
// is ambiguous costs, whatever else there is, and a row of many is decided at once.
#include <benchmark/benchmark.h>

#include <cmath>
#include <vector>

#include <Eigen/Core>

#include "common/association/multiple_hypotheses.hpp"
#include "common/association/ranked_assignments.hpp"

namespace slammot::association {
namespace {

using Eigen::Vector2d;

struct Points {
  static constexpr double kSigmaM = 0.15;
  std::vector<Vector2d> positions_m;

  std::size_t measurement_count() const { return positions_m.size(); }
  std::size_t capacity(std::size_t) const { return 1; }
  double pair_cost(TrackKey, const Vector2d& state_m, std::size_t measurement, std::size_t) const {
    const double distance2 =
        (positions_m[measurement] - state_m).squaredNorm() / (2.0 * kSigmaM * kSigmaM);
    return distance2 > 13.8 ? kForbidden : distance2;
  }
  double miss_cost(TrackKey, const Vector2d&) const { return 25.0; }
  Vector2d updated(TrackKey, const Vector2d& state_m, std::size_t measurement, std::size_t) const {
    return 0.9 * state_m + 0.1 * positions_m[measurement];
  }
  Vector2d missed(TrackKey, const Vector2d& state_m) const { return state_m; }
  bool are_same(const Vector2d& a_m, const Vector2d& b_m) const {
    return (a_m - b_m).squaredNorm() < 1e-3;
  }
};

void step_hypotheses(benchmark::State& state) {
  const auto tracks = static_cast<int>(state.range(0));
  const auto neighbours = static_cast<int>(state.range(1));
  MultipleHypotheses<Vector2d> hypotheses({});
  Points scan;
  for (int i = 0; i < tracks; ++i) {
    scan.positions_m.emplace_back(0.4 * (i % neighbours), 3.0 * (i / neighbours));
    hypotheses.add(static_cast<TrackKey>(i), scan.positions_m.back());
  }
  for (auto _ : state) hypotheses.step(scan);
}
BENCHMARK(step_hypotheses)
    ->Args({20, 1})
    ->Args({20, 2})
    ->Args({20, 5})
    ->Args({100, 1})
    ->Args({100, 2})
    ->Args({100, 20})
    ->Unit(benchmark::kMicrosecond);

void rank_assignments(benchmark::State& state) {
  const auto size = static_cast<std::size_t>(state.range(0));
  CostMatrix costs(size, size, 0.0);
  for (std::size_t i = 0; i < size; ++i)
    for (std::size_t j = 0; j < size; ++j)
      costs(i, j) = std::abs(static_cast<double>(i) - static_cast<double>(j)) +
                    0.01 * static_cast<double>((7 * i + 3 * j) % 11);
  AssignmentRanking ranking;
  for (auto _ : state)
    benchmark::DoNotOptimize(ranking.rank(costs, 9.0, static_cast<std::size_t>(state.range(1))));
}
BENCHMARK(rank_assignments)
    ->Args({4, 3})
    ->Args({8, 3})
    ->Args({8, 10})
    ->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace slammot::association
