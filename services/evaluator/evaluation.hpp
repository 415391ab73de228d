#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "common/files/result.hpp"
#include "common/metrics/detection.hpp"
#include "common/metrics/gospa.hpp"
#include "common/metrics/hota.hpp"
#include "common/metrics/identity.hpp"
#include "common/metrics/map_quality.hpp"
#include "common/metrics/object_errors.hpp"
#include "common/metrics/prediction_errors.hpp"
#include "services/evaluator/echoes.hpp"
#include "services/evaluator/result_files.hpp"
#include "services/evaluator/truth_files.hpp"
#include "services/evaluator/wall_sharpness.hpp"

namespace slammot::evaluator {

struct EvaluationOptions {
  metrics::CountingRule rule;
  double max_stamp_difference_s = 0.01;  ///< Equals evo's --t_max_diff.
  double longest_occlusion_s = 5.0;      ///< After a longer occlusion an object counts as new.
  double map_tolerance_m = 0.3;  ///< Greatest distance from the centre of an occupied cell to a
                                 ///< wall.
  WallSharpnessOptions walls;
};

/// Relative pose errors over pairs `delta_m` of path apart.
struct RelativeErrors {
  double delta_m = 0.0;
  metrics::ErrorSummary consecutive_m;  ///< Equals `evo_rpe -d N -u m`.
  metrics::ErrorSummary drift_m;  ///< From every pose, by the true path (`--all_pairs`, pairs from
                                  ///< the reference).
  metrics::ErrorSummary drift_rad;
};

struct TrajectoryEvaluation {
  std::size_t poses = 0;
  std::size_t pairs = 0;
  geometry::Pose2 world_from_map;               ///< By rigid alignment.
  metrics::ErrorSummary absolute_m;             ///< After rigid alignment.
  metrics::ErrorSummary absolute_from_start_m;  ///< After alignment of the first pose.
  std::vector<RelativeErrors> relative;
  std::vector<metrics::PosePair> matched;
};

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
};

/// Against motion capture of one other car. The estimated pose of the ego car transforms tracks
/// into the world.
struct OtherCarEvaluation {
  std::size_t scans = 0;  ///< With both cars in the truth.
  std::size_t matched_scans = 0;
  std::size_t identities = 0;  ///< Number of different matched tracks.
  metrics::ErrorSummary position_m;
  metrics::ErrorSummary velocity_mps;
  double false_moving_tracks_a_scan = 0.0;
};

/// Labels of points against the true origin of their echoes.
struct DetectionEvaluation {
  std::size_t scans = 0;
  metrics::DetectionCounts by_detection;
  metrics::DetectionCounts by_tracking;
};

/// Parts without truth or result are empty, and notes name them.
struct Evaluation {
  TrajectoryEvaluation online;
  TrajectoryEvaluation corrected;
  std::optional<TrajectoryEvaluation> without_loops;  ///< In odom, without loop closures; requires
                                                      ///< online_covariance.csv.
  std::optional<metrics::NeesSummary> relative_pose_nees;
  std::optional<DetectionEvaluation> detection;
  std::optional<TrackingEvaluation> tracking;
  std::optional<OtherCarEvaluation> other_car;
  std::optional<metrics::MapQuality> map;
  std::optional<WallSharpness> walls;  ///< Filled by the caller, who has the log.
  std::vector<std::string> notes;
  std::vector<metrics::Scene> scenes;    ///< Truth and tracks of each scan, in world.
  std::vector<std::uint32_t> track_ids;  ///< By the index of tracks in the scenes.
  std::vector<metrics::CountedScene> counted;
};

/// Matched poses after rigid alignment of the estimate. Leaves out dropped scans, whose poses in
/// the trajectory are interpolated, if the result tells which scans were localized.
std::vector<metrics::PosePair> localized_in_world(const RunResult& result,
                                                  const TrajectoryEvaluation& trajectory);

/// Passes the echoes of every scan to `take`.
using EchoSource = std::function<std::optional<files::Error>(
    const std::function<void(const EchoesInWorld&)>& take)>;

/// Compares a run with the truth. Without echoes (empty), detection is not evaluated. Fails with
/// one line if both cannot be of one drive: no common time, different motion, or objects far from
/// the vehicle.
files::Result<Evaluation> evaluate(const RunResult& result, const Truth& truth,
                                   const EchoSource& echoes, const EvaluationOptions& options);

}  // namespace slammot::evaluator
