#pragma once

#include <vector>

#include "common/metrics/nees.hpp"
#include "common/metrics/scene.hpp"
#include "common/metrics/statistics.hpp"

namespace slammot::metrics {

/// How far from where they were said to be objects were, so much later.
struct PredictionErrors {
  double after_s = 0.0;
  ErrorSummary displacement_m;
  NeesSummary nees;           ///< Once a second and object.
  double inside_share = 0.0;  ///< Of these samples, the share inside the ellipse that is to hold 95 %.
};

/// Of all matched tracks, by how far ahead their predictions are. Scenes ascend in time; scenes, what counts of each, and the
/// matches of clear_mot are of the same length and order. Where an object is between two scenes is on the line between
/// its places there; a prediction of a time without a true place does not count.
std::vector<PredictionErrors> prediction_errors(const std::vector<Scene>& scenes, const std::vector<CountedScene>& counted,
                                                const std::vector<std::vector<Match>>& matches);

}  // namespace slammot::metrics
