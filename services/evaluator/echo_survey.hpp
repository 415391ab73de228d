#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "common/files/result.hpp"
#include "common/metrics/detection.hpp"
#include "services/evaluator/echoes.hpp"
#include "services/evaluator/result_files.hpp"
#include "services/evaluator/truth_files.hpp"

namespace slammot::evaluator {

/// Labels of points against the true origin of their echoes.
struct DetectionEvaluation {
  std::size_t scans = 0;
  metrics::DetectionCounts by_detection;
  metrics::DetectionCounts by_tracking;
};

/// Results of one pass over the echoes of the drive.
struct EchoSurvey {
  std::optional<DetectionEvaluation> detection;
  std::vector<geometry::Vector2> wall_points_m;  ///< In world; one point per square with an echo.
  std::vector<geometry::Vector2> object_points_m;
};

struct EchoSurveyOptions {
  metrics::CountingRule rule;
  double spacing_m = 0.0;  ///< Side of the squares.
};

/// Compares the labels of echoes with their true origin, collects the places of echoes, and notes
/// in the scenes how much of each object's outline is seen. Empty without echoes.
files::Result<EchoSurvey> survey_echoes(const EchoSource& echoes, const RunResult& result,
                                        std::vector<metrics::Scene>& scenes, const Truth& truth,
                                        const EchoSurveyOptions& options);

}  // namespace slammot::evaluator
