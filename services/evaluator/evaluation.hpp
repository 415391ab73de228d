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
  double max_stamp_difference_s = 0.01;  ///< As evo's --t_max_diff.
  double longest_occlusion_s = 5.0;      ///< Hidden for longer, an object has gone.
  double map_tolerance_m = 0.3;          ///< From an occupied cell's centre to a wall.
  WallSharpnessOptions walls;
};

/// Over pairs about so many metres of path apart.
struct RelativeErrors {
  double delta_m = 0.0;
  metrics::ErrorSummary consecutive_m;  ///< As `evo_rpe -d N -u m`.
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
  double distance_m = 0.0;  ///< Means over the scans, these too:
  double localization_m2 = 0.0;
  double missed_m2 = 0.0;
  double false_tracks_m2 = 0.0;
};

struct TrackingEvaluation {
  std::size_t scans = 0;
  std::size_t objects = 0;  ///< That counted at any time.
  std::size_t tracks = 0;   ///< Different ones that counted.
  metrics::ClearMot clear;
  metrics::Identity identity;
  metrics::Hota hota;
  MeanGospa gospa;
  metrics::ObjectErrorTables errors;
  std::vector<metrics::PredictionErrors> predictions;  ///< By how far ahead; empty where none were
                                                       ///< written.
};

/// Against motion capture of one other car; the ego car's own estimate is what brings tracks into
/// the world.
struct OtherCarEvaluation {
  std::size_t scans = 0;  ///< With both cars in the truth.
  std::size_t matched_scans = 0;
  std::size_t identities = 0;  ///< Different tracks that were matched.
  metrics::ErrorSummary position_m;
  metrics::ErrorSummary velocity_mps;
  double false_moving_tracks_a_scan = 0.0;
};

/// Labels of points against what the points truly came from.
struct DetectionEvaluation {
  std::size_t scans = 0;
  metrics::DetectionCounts by_detection;
  metrics::DetectionCounts by_tracking;
};

/// A part is missing where there was no truth or no result for it; notes say so.
struct Evaluation {
  TrajectoryEvaluation online;
  TrajectoryEvaluation corrected;
  std::optional<TrajectoryEvaluation> without_loops;  ///< In odom, where no closed loop helps;
                                                      ///< needs online_covariance.csv.
  std::optional<metrics::NeesSummary> relative_pose_nees;
  std::optional<DetectionEvaluation> detection;
  std::optional<TrackingEvaluation> tracking;
  std::optional<OtherCarEvaluation> other_car;
  std::optional<metrics::MapQuality> map;
  std::optional<WallSharpness> walls;  ///< Filled in by who has the log and wants to know.
  std::vector<std::string> notes;
  std::vector<metrics::Scene> scenes;    ///< Truth and tracks of each scan, in the world's frame.
  std::vector<std::uint32_t> track_ids;  ///< Of the indices of tracks in the scenes.
  std::vector<metrics::CountedScene> counted;
};

/// The matched poses, the estimated ones brought into the world by the rigid alignment. Scans that
/// were dropped have a pose between their neighbours in the trajectory, and none here, where the
/// result says which were localized.
std::vector<metrics::PosePair> localized_in_world(const RunResult& result,
                                                  const TrajectoryEvaluation& trajectory);

/// Hands over the echoes of every scan of the drive.
using EchoSource = std::function<std::optional<files::Error>(
    const std::function<void(const EchoesInWorld&)>& take)>;

/// Compares a run with the truth; without echoes, which may be empty, detection is not evaluated.
/// Fails with one line where they cannot be of the same drive: no common time, other motion, or
/// objects nowhere near.
files::Result<Evaluation> evaluate(const RunResult& result, const Truth& truth,
                                   const EchoSource& echoes, const EvaluationOptions& options);

}  // namespace slammot::evaluator
