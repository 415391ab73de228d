#pragma once

#include <cmath>

#include "common/simulation/random.hpp"

namespace slammot::simulation {

/// Correlated error: first-order Gauss-Markov process with standard deviation 1.
class DriftingError {
 public:
  explicit DriftingError(Random& random) : value_(random.normal()) {}

  double value() const { return value_; }
  /// The error after this step in time or distance; `length` is the correlation length.
  void advance(double by, double length, Random& random) {
    const double kept = std::exp(-by / length);
    value_ = kept * value_ + std::sqrt(1.0 - kept * kept) * random.normal();
  }

 private:
  double value_;
};

}  // namespace slammot::simulation
