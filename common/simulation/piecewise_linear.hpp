#pragma once

#include <algorithm>
#include <vector>

namespace slammot::simulation {

/// Piecewise linear interpolation at `at` over knots with ascending `at`; constant before the first
/// and after the last, 0 without knots. Two members of a knot are its place and its value.
template <typename Knot>
double piecewise_linear(const std::vector<Knot>& knots, double Knot::*place, double Knot::*value,
                        double at) {
  if (knots.empty()) return 0.0;
  const auto after =
      std::find_if(knots.begin(), knots.end(), [&](const Knot& knot) { return knot.*place > at; });
  if (after == knots.begin()) return knots.front().*value;
  if (after == knots.end()) return knots.back().*value;
  const Knot& before = *(after - 1);
  return before.*value + (at - before.*place) / ((*after).*place - before.*place) *
                             ((*after).*value - before.*value);
}

}  // namespace slammot::simulation
