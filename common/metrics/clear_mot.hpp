#pragma once

#include <cstddef>
#include <vector>

#include "common/metrics/matching.hpp"

namespace slammot::metrics {

/// CLEAR-MOT: Bernardin and Stiefelhagen 2008. Counts are of rows, one object in one scan each.
struct ClearMot {
  std::size_t true_positives = 0;
  std::size_t false_positives = 0;
  std::size_t misses = 0;
  std::size_t switches = 0;  ///< The object was last matched by another track, at any earlier time.
  std::size_t fragmentations = 0;  ///< The object is matched again after a gap.
  std::size_t mostly_tracked = 0;  ///< Objects matched in over 80 % of their rows,
  std::size_t mostly_lost = 0;     ///< and in under 20 %.
  double mota = 0.0;
  double motp = 0.0;  ///< Mean similarity of the pairs.
  double recall = 0.0;
  double precision = 0.0;
  std::vector<std::vector<Match>> matches;  ///< Of each frame.
};

/// A pair may be matched from the given similarity on. In each scan pairs of the previous scan are
/// kept if still allowed; then the sum of similarities is maximized, as in PyPI `trackeval`.
ClearMot clear_mot(const MotSequence& sequence, double least_similarity);

}  // namespace slammot::metrics
