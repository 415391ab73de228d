#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "common/metrics/nees.hpp"
#include "common/metrics/published_rows.hpp"
#include "common/metrics/scene.hpp"
#include "common/metrics/statistics.hpp"

namespace slammot::metrics {

/// Occlusions whose length is in [from_s, to_s): from the first scan in which an object has no echo
/// to the first one with an echo after it.
struct OcclusionBand {
  double from_s = 0.0;
  double to_s = 0.0;
  std::size_t kept = 0;          ///< The track before is also the first one after.
  std::size_t occlusions = 0;    ///< Of objects that were tracked before.
  std::size_t covered_rows = 0;  ///< Of the hidden rows: the object's own track is at its box.
  std::size_t hidden_rows = 0;   ///< Scans in which the object has no echo.

  double kept_share() const;
  double covered_share() const;
};

struct OcclusionFigures {
  std::array<OcclusionBand, 4> by_length = {{{0.15, 1.0}, {1.0, 3.0}, {3.0, 5.0}, {5.0, 10.0}}};
  ErrorSummary position_m;    ///< Of the centre, while hidden; of the own track.
  NeesSummary position_nees;  ///< Likewise, once a second, the first time 0.5 s after the object
                              ///< was seen last.
  double inside_share = 0.0;  ///< Of these samples: share inside the 95 % ellipse.
  PublishedRows published;
};

/// Judges how tracks pass through occlusions; definitions in docs/evaluation.md. Scenes ascend in
/// time. Where an object is hidden is taken from Scene::hidden_objects; without them, from rows of
/// Scene::objects without points, as fill_gaps() adds.
OcclusionFigures occlusion_figures(const std::vector<Scene>& scenes, const CountingRule& rule);

}  // namespace slammot::metrics
