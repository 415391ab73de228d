#pragma once

#include <cstddef>
#include <vector>

#include "common/metrics/coverage.hpp"
#include "common/metrics/scene.hpp"

namespace slammot::metrics {

/// Rows of tracks reported as occluded, by what is within the gate of their position.
struct OccludedRows {
  std::size_t at_own_object = 0;  ///< The object that the track covered last.
  std::size_t at_other_object = 0;
  std::size_t at_nothing = 0;

  std::size_t rows() const { return at_own_object + at_other_object + at_nothing; }
  double precision() const;  ///< Share at the own object.
};

/// Interruptions of what is published of a track between its first and its last row.
struct PublicationGaps {
  std::size_t gaps = 0;
  std::size_t missing_rows = 0;
  std::size_t gaps_on_object = 0;  ///< Of the gaps: the track is on the same object afterwards;
  std::size_t gaps_in_view = 0;    ///< of these: which has echoes in more than half of the missing
                                   ///< rows.
  std::size_t missing_rows_in_view = 0;
};

struct PublishedRows {
  OccludedRows occluded;
  PublicationGaps gaps;
};

/// Judges rows of occluded tracks and interruptions of tracks; timelines of the same scenes.
PublishedRows published_rows(const std::vector<Scene>& scenes, const Timelines& timelines,
                             const CountingRule& rule);

}  // namespace slammot::metrics
