#pragma once

#include <vector>

#include "common/metrics/nees.hpp"
#include "common/metrics/scene.hpp"
#include "common/metrics/statistics.hpp"

namespace slammot::metrics {

/// Errors of predicted positions.
struct PredictionErrors {
  double after_s = 0.0;
  ErrorSummary displacement_m;
  NeesSummary nees;           ///< Once a second and object.
  double inside_share = 0.0;  ///< Of these samples, the share inside the 95 % ellipse.
};

/// Over all matched tracks, by prediction time. Scenes ascend in time; scenes, counted objects and
/// matches of clear_mot have the same length and order. True positions are interpolated between
/// scenes; predictions for times without truth are ignored.
std::vector<PredictionErrors> prediction_errors(const std::vector<Scene>& scenes,
                                                const std::vector<CountedScene>& counted,
                                                const std::vector<std::vector<Match>>& matches);

}  // namespace slammot::metrics
