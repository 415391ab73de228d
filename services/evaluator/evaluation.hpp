#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "common/files/result.hpp"
#include "common/metrics/map_quality.hpp"
#include "common/metrics/occlusion.hpp"
#include "services/evaluator/echo_survey.hpp"
#include "services/evaluator/echoes.hpp"
#include "services/evaluator/other_car_evaluation.hpp"
#include "services/evaluator/result_files.hpp"
#include "services/evaluator/tracking_evaluation.hpp"
#include "services/evaluator/trajectory_evaluation.hpp"
#include "services/evaluator/truth_files.hpp"
#include "services/evaluator/wall_sharpness.hpp"
#include "services/evaluator/way_evaluation.hpp"

namespace slammot::evaluator {

struct EvaluationOptions {
  metrics::CountingRule rule;
  double max_stamp_difference_s = 0.01;  ///< Equals evo's --t_max_diff.
  double longest_occlusion_s = 5.0;      ///< After a longer occlusion an object counts as new.
  double map_tolerance_m = 0.3;  ///< Greatest distance from the centre of an occupied cell to a
                                 ///< wall.
  WallSharpnessOptions walls;
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
  std::optional<metrics::OcclusionFigures> occlusion;
  std::optional<OtherCarEvaluation> other_car;
  std::optional<metrics::MapQuality> map;
  std::optional<WayEvaluation> ways;
  std::optional<WallSharpness> walls;  ///< Filled by the caller, who has the log.
  bool motion_differs = false;  ///< From the true one by as much as its length: nothing but the
                                ///< trajectories is evaluated, and a note says so.
  std::vector<std::string> notes;
  std::vector<metrics::Scene> scenes;    ///< Truth and tracks of each scan, in world.
  std::vector<std::uint32_t> track_ids;  ///< By the index of tracks in the scenes.
  std::vector<metrics::CountedScene> counted;
};

/// Compares a run with the truth. Without echoes (empty), detection is not evaluated. Fails with
/// one line if both cannot be of one drive: no common time, or objects far from the vehicle.
files::Result<Evaluation> evaluate(const RunResult& result, const Truth& truth,
                                   const EchoSource& echoes, const EvaluationOptions& options);

}  // namespace slammot::evaluator
