#pragma once

#include <cmath>

namespace slammot::grids {

/// Log-odds in steps of 1/16: fits one byte a cell, and is finer than the accuracy of any sensor
/// model.
constexpr double kLogOddsStep = 1.0 / 16.0;

/// Nearest whole number of steps.
inline int steps_of_log_odds(double log_odds) {
  return static_cast<int>(std::lround(log_odds / kLogOddsStep));
}

}  // namespace slammot::grids
