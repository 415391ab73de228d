#pragma once

#include <cstddef>
#include <vector>

#include "common/metrics/gospa.hpp"
#include "common/metrics/hota.hpp"
#include "common/metrics/identity.hpp"
#include "common/metrics/object_errors.hpp"
#include "common/metrics/prediction_errors.hpp"
#include "common/metrics/strict_figures.hpp"
#include "services/evaluator/scenes.hpp"

namespace slammot::evaluator {

struct MeanGospa {
  double distance_m = 0.0;  ///< Each member is a mean over scans.
  double localization_m2 = 0.0;
  double missed_m2 = 0.0;
  double false_tracks_m2 = 0.0;
};

struct TrackingEvaluation {
  std::size_t scans = 0;
  std::size_t objects = 0;  ///< Objects that counted in some scan.
  std::size_t tracks = 0;   ///< Tracks that counted in some scan.
  metrics::ClearMot clear;
  metrics::Identity identity;
  metrics::Hota hota;
  MeanGospa gospa;
  metrics::ObjectErrorTables errors;
  std::vector<metrics::PredictionErrors> predictions;  ///< By horizon; empty if none were written.
  metrics::VehicleBoxErrors vehicle_boxes;
  metrics::Hota strict_hota;
  metrics::StoppedRows stopped;
};

/// Tracks against true objects. `counted`: the counted objects and tracks of each scene.
TrackingEvaluation evaluate_tracking(const Scenes& scenes,
                                     const std::vector<metrics::CountedScene>& counted,
                                     std::size_t object_count, const metrics::CountingRule& rule);

}  // namespace slammot::evaluator
