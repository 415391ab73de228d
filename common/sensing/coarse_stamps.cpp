#include "common/sensing/coarse_stamps.hpp"

#include <algorithm>
#include <cmath>

#include "common/geometry/order_statistics.hpp"
#include "common/sensing/stamp_steps.hpp"

namespace slammot::sensing {
namespace {

/// Largest of 10, 1, 0.1 and 0.01 s that divides all stamps; 1 ns if none does.
std::int64_t quantum_ns(const std::vector<std::int64_t>& stamps) {
  for (const std::int64_t quantum : {std::int64_t{10'000'000'000}, std::int64_t{1'000'000'000},
                                     std::int64_t{100'000'000}, std::int64_t{10'000'000}}) {
    if (share_of(stamps, [=](std::int64_t stamp_ns) { return stamp_ns % quantum == 0; }) >= 0.999)
      return quantum;
  }
  return 1;
}

/// True if stamps are rounded so coarsely that steps do not measure the time between scans. A round
/// period of a steady scanner is not rounding.
bool is_coarse(const std::vector<std::int64_t>& stamps, std::int64_t quantum) {
  constexpr double kFineShareOfPeriod = 0.3;
  constexpr double kSteadyShare = 0.8;  // a steady scanner sometimes repeats a stamp or misses a
                                        // scan
  const double period_ns =
      static_cast<double>(stamps.back() - stamps.front()) / static_cast<double>(stamps.size() - 1);
  const std::vector<std::int64_t> steps = steps_of(stamps);
  const std::int64_t median_ns = geometry::upper_median(steps);
  const bool is_steady = median_ns > 0 && share_of(steps, [=](std::int64_t step) {
                                            return step == median_ns;
                                          }) >= kSteadyShare;
  return !is_steady && static_cast<double>(quantum) > kFineShareOfPeriod * period_ns;
}

/// Relative time for the way to each scan; 1 if the vehicle hardly moves.
std::vector<double> weights_by_way(std::span<const ScanMark> scans) {
  std::vector<double> ways = ways_of(scans);
  const double usual = geometry::upper_median(ways);
  if (!(usual > 0.0)) return std::vector<double>(scans.size(), 1.0);
  for (double& way : ways) way = std::clamp(way / usual, 0.2, 5.0);
  return ways;
}

/// Relative spread of the time per weight, over stretches of scans much longer than the quantum.
double unevenness(const std::vector<std::int64_t>& stamps, const std::vector<double>& weights,
                  std::int64_t quantum) {
  std::vector<double> seconds_per_weight;
  double weight = 0.0;
  std::size_t begin = 0;
  for (std::size_t i = 1; i < stamps.size(); ++i) {
    weight += weights[i];
    if (stamps[i] - stamps[begin] < 5 * quantum || i - begin < 5) continue;
    seconds_per_weight.push_back(static_cast<double>(stamps[i] - stamps[begin]) / weight);
    weight = 0.0;
    begin = i;
  }
  const double middle = geometry::upper_median(seconds_per_weight);
  if (!(middle > 0.0)) return 0.0;
  std::vector<double> deviations;
  for (const double each : seconds_per_weight)
    deviations.push_back(std::abs(each - middle) / middle);
  return geometry::upper_median(std::move(deviations));
}

/// Position within each run of equal stamps, by weight, as a first guess.
std::vector<double> guess_within_quantum(const std::vector<std::int64_t>& stamps,
                                         const std::vector<double>& weights, double quantum_s) {
  std::vector<double> times_s(stamps.size());
  for (std::size_t begin = 0; begin < stamps.size();) {
    std::size_t end = begin;
    double total = 0.0;
    for (; end < stamps.size() && stamps[end] == stamps[begin]; ++end) total += weights[end];
    double passed = 0.0;
    for (std::size_t i = begin; i < end; ++i) {
      times_s[i] = 1e-9 * static_cast<double>(stamps[i] - stamps.front()) +
                   quantum_s * (passed + 0.5 * weights[i]) / total;
      passed += weights[i];
    }
    begin = end;
  }
  return times_s;
}

/// Minimizes the sum of (step_i - rate * weight_i)^2 / weight_i, with every time within the quantum
/// that begins at its stamp. The problem is convex and is solved by projected successive
/// over-relaxation. The free ends advance at the usual rate.
std::vector<std::int64_t> spread_within_quantum(const std::vector<std::int64_t>& stamps,
                                                const std::vector<double>& weights,
                                                std::int64_t quantum) {
  constexpr int kSweeps = 300;
  constexpr double kRelaxation = 1.8;
  constexpr std::int64_t kLeastStepNs = 1'000;
  const std::size_t n = stamps.size();
  const double quantum_s = 1e-9 * static_cast<double>(quantum);
  double total_weight = 0.0;
  for (std::size_t i = 1; i < n; ++i) total_weight += weights[i];
  const double rate = 1e-9 * static_cast<double>(stamps.back() - stamps.front()) / total_weight;
  std::vector<double> times_s = guess_within_quantum(stamps, weights, quantum_s);
  for (int sweep = 0; sweep < kSweeps; ++sweep) {
    for (std::size_t i = 0; i < n; ++i) {
      const double before = i > 0 ? 1.0 / weights[i] : 0.0;
      const double after = i + 1 < n ? 1.0 / weights[i + 1] : 0.0;
      double pulled = 0.0;
      if (i > 0) pulled += before * (times_s[i - 1] + rate * weights[i]);
      if (i + 1 < n) pulled += after * (times_s[i + 1] - rate * weights[i + 1]);
      const double lowest_s = 1e-9 * static_cast<double>(stamps[i] - stamps.front());
      const double relaxed_s = times_s[i] + kRelaxation * (pulled / (before + after) - times_s[i]);
      times_s[i] = std::clamp(relaxed_s, lowest_s, lowest_s + quantum_s);
    }
  }
  std::vector<std::int64_t> spread(n);
  for (std::size_t i = 0; i < n; ++i) {
    spread[i] = stamps.front() + std::llround(times_s[i] * 1e9);
    if (i > 0 && stamps[i] >= stamps[i - 1])
      spread[i] = std::max(spread[i], spread[i - 1] + kLeastStepNs);
  }
  return spread;
}

}  // namespace

std::optional<SpreadStamps> spread_if_coarse(std::span<const ScanMark> scans,
                                             const std::vector<std::int64_t>& stamps_ns) {
  const std::int64_t quantum = quantum_ns(stamps_ns);
  if (quantum == 1 || !is_coarse(stamps_ns, quantum)) return std::nullopt;
  const std::vector<double> by_way = weights_by_way(scans);
  const std::vector<double> by_count(scans.size(), 1.0);
  const bool way_is_evener =
      unevenness(stamps_ns, by_way, quantum) < unevenness(stamps_ns, by_count, quantum);
  return SpreadStamps{spread_within_quantum(stamps_ns, way_is_evener ? by_way : by_count, quantum),
                      1e-9 * static_cast<double>(quantum)};
}

}  // namespace slammot::sensing
