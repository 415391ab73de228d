#pragma once

#include <cstddef>

#include "common/metrics/matching.hpp"

namespace slammot::metrics {

/// Identity metrics: Ristani et al. 2016. One track represents one object over the whole sequence;
/// other rows are errors.
struct Identity {
  std::size_t true_positives = 0;
  std::size_t false_positives = 0;
  std::size_t false_negatives = 0;
  double f1 = 0.0;
  double precision = 0.0;
  double recall = 0.0;
};

/// A row counts as common to object and track from the given similarity on.
Identity identity(const MotSequence& sequence, double least_similarity);

}  // namespace slammot::metrics
