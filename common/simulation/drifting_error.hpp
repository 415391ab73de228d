#pragma once

#include <cmath>

#include "common/simulation/random.hpp"

namespace slammot::simulation {

/// An error that stays alike over some time or way: Gauss and Markov's process of first order, standard deviation 1.
class DriftingError {
 public:
  explicit DriftingError(Random& random) : value_(random.normal()) {}

  double value() const { return value_; }
  /// After so much of whatever it drifts with; alike over about `length` of it.
  void advance(double by, double length, Random& random) {
    const double kept = std::exp(-by / length);
    value_ = kept * value_ + std::sqrt(1.0 - kept * kept) * random.normal();
  }

 private:
  double value_;
};

}  // namespace slammot::simulation
