#include "services/tracking/beam_run.hpp"

#include <algorithm>
#include <utility>

namespace slammot::tracking {

BeamRun run_of(const std::vector<std::uint16_t>& beams, const PolarView& view) {
  if (!view.goes_all_round()) return {0, beams.front(), beams.back()};
  std::size_t start = 0;
  std::size_t widest = 0;
  for (std::size_t i = 0; i < beams.size(); ++i) {
    const std::size_t gap = view.steps_between(beams[i == 0 ? beams.size() - 1 : i - 1], beams[i]);
    if (gap > widest) start = i, widest = gap;
  }
  return {start, beams[start], beams[start == 0 ? beams.size() - 1 : start - 1]};
}

int gaps_between(const std::vector<std::uint16_t>& beams, const PolarView& view) {
  const BeamRun run = run_of(beams, view);
  const std::size_t steps = view.steps_between(run.first, run.last);
  int gaps = 0;
  for (std::size_t i = 1; i < steps; ++i)
    gaps += view.range_m(*view.neighbour_of(run.first, static_cast<long>(i))) <= 0.0 ? 1 : 0;
  return gaps;
}

bool is_seen_between(const std::vector<std::uint16_t>& a, const std::vector<std::uint16_t>& b,
                     const PolarView& view) {
  constexpr double kBeyondM = 0.7;
  constexpr int kMost = 1;
  BeamRun before = run_of(a, view);
  BeamRun after = run_of(b, view);
  const auto begins_within = [&](const BeamRun& one, const BeamRun& other) {
    return view.steps_between(other.first, one.first) <=
           view.steps_between(other.first, other.last);
  };
  if (begins_within(before, after) || begins_within(after, before)) return false;
  if (view.steps_between(before.last, after.first) > view.steps_between(after.last, before.first))
    std::swap(before, after);
  const std::size_t steps = view.steps_between(before.last, after.first);
  const double farther_m = std::max(view.range_m(before.last), view.range_m(after.first));
  int beyond = 0;
  for (std::size_t i = 1; i < steps; ++i)
    beyond +=
        view.range_m(*view.neighbour_of(before.last, static_cast<long>(i))) > farther_m + kBeyondM
            ? 1
            : 0;
  return beyond > kMost;
}

}  // namespace slammot::tracking
