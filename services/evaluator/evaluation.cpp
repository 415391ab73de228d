#include "services/evaluator/evaluation.hpp"

#include <cmath>
#include <utility>

#include "services/evaluator/annotations.hpp"
#include "services/evaluator/map_cells.hpp"
#include "services/evaluator/scenes.hpp"
#include "services/evaluator/table_file.hpp"

namespace slammot::evaluator {
namespace {

using files::Error;

metrics::Trajectory without_loops(const RunResult& result) {
  metrics::Trajectory trajectory;
  for (const metrics::UncertainStampedPose& pose : result.uncertain)
    trajectory.push_back({pose.stamp_ns, pose.odom_from_base.pose});
  return trajectory;
}

std::vector<metrics::TrueObject> moving_objects(const Truth& truth, double least_speed_mps) {
  std::vector<metrics::TrueObject> moving;
  if (!truth.objects) return moving;
  for (const ObjectsAt& at : *truth.objects) {
    for (const metrics::TrueObject& object : at.objects) {
      if (std::abs(object.speed_mps) >= least_speed_mps) moving.push_back(object);
    }
  }
  return moving;
}

void add_notes(const RunResult& result, const Truth& truth, const EchoSource& echoes,
               Evaluation& evaluation) {
  if (!truth.objects && !truth.other_car)
    evaluation.notes.emplace_back("no true objects: tracking is not evaluated");
  if (truth.objects && !echoes)
    evaluation.notes.emplace_back(
        "no log: labels of points are not evaluated, and walls count as seen where the map is "
        "known");
  if (truth.objects && result.labels.empty())
    evaluation.notes.emplace_back(
        "no labels.csv in the result: labels of points are not evaluated");
  if (!truth.walls) evaluation.notes.emplace_back("no true walls: the map is not evaluated");
  if (truth.walls && !result.map)
    evaluation.notes.emplace_back("no map.pgm in the result: the map is not evaluated");
  if (result.uncertain.empty())
    evaluation.notes.emplace_back("no online_covariance.csv in the result: no NEES of poses");
}

/// Evaluates the trajectories.
std::optional<Error> evaluate_trajectories(const RunResult& result, const Truth& truth,
                                           std::int64_t max_difference_ns, Evaluation& evaluation) {
  evaluation.online = evaluate_trajectory(truth.trajectory, result.online, max_difference_ns);
  if (auto fault = fault_of_overlap(truth.trajectory, result.online, evaluation.online.matched))
    return *fault;
  evaluation.corrected = evaluate_trajectory(truth.trajectory, result.corrected, max_difference_ns);
  if (!result.uncertain.empty()) {
    evaluation.without_loops =
        evaluate_trajectory(truth.trajectory, without_loops(result), max_difference_ns);
    constexpr std::int64_t kOneSecondNs = 1'000'000'000;
    evaluation.relative_pose_nees =
        metrics::summarize_nees(metrics::relative_pose_nees(truth.trajectory, result.uncertain,
                                                            kOneSecondNs, max_difference_ns),
                                3);
  }
  return std::nullopt;
}

/// Evaluates detection, tracking and the map.
std::optional<Error> evaluate_scenes(const RunResult& result, const Truth& truth,
                                     const EchoSource& echoes, const EvaluationOptions& options,
                                     Evaluation& evaluation) {
  const std::int64_t max_difference_ns = to_ns(options.max_stamp_difference_s);
  Scenes made = make_scenes(result, truth, max_difference_ns);
  if (auto fault = fault_of_objects(made.scenes, truth.objects && !truth.objects->empty()))
    return *fault;
  made.scenes = metrics::fill_gaps(std::move(made.scenes), to_ns(options.longest_occlusion_s));
  auto survey = survey_echoes(echoes, result, made.scenes, truth,
                              {options.rule, 0.25 * options.map_tolerance_m});
  if (!survey) return survey.error();
  evaluation.detection = survey->detection;
  if (truth.other_car) evaluation.other_car = evaluate_other_car(made.scenes, *truth.other_car);
  if (truth.objects) {
    for (const metrics::Scene& scene : made.scenes)
      evaluation.counted.push_back(metrics::count_scene(scene, options.rule));
    evaluation.tracking =
        evaluate_tracking(made, evaluation.counted, truth.object_count, options.rule);
    evaluation.occlusion = metrics::occlusion_figures(made.scenes, options.rule);
    if (result.ways && !truth.annotated)
      evaluation.ways = evaluate_ways(
          *result.ways,
          true_steps(made.scenes, geometry::inverse(evaluation.corrected.world_from_map),
                     options.rule));
  }
  if (truth.walls && result.map) {
    evaluation.map =
        metrics::map_quality(cells_of(*result.map), evaluation.corrected.world_from_map,
                             {*truth.walls, moving_objects(truth, options.rule.least_speed_mps),
                              survey->wall_points_m, survey->object_points_m},
                             options.map_tolerance_m);
  }
  evaluation.track_ids = std::move(made.track_ids);
  evaluation.scenes = std::move(made.scenes);
  add_notes(result, truth, echoes, evaluation);
  return std::nullopt;
}

}  // namespace

files::Result<Evaluation> evaluate(const RunResult& result, const Truth& truth,
                                   const EchoSource& echoes, const EvaluationOptions& options) {
  Evaluation evaluation;
  if (truth.annotated) {
    const Truth placed = place_annotations(truth, result, options.rule.least_points);
    if (placed.objects->empty())
      return Error{"the clocks do not overlap: no scan of the result (" + span_of(result.online) +
                   ") is between two annotations"};
    if (auto fault = evaluate_scenes(result, placed, echoes, options, evaluation)) return *fault;
    evaluation.notes.emplace_back(
        "annotated in the frame of the laser: no trajectory is evaluated, and objects are placed "
        "by the result's trajectory");
    return evaluation;
  }
  if (auto fault =
          evaluate_trajectories(result, truth, to_ns(options.max_stamp_difference_s), evaluation))
    return *fault;
  if (auto doubt = doubt_of_motion(evaluation.online.matched)) {
    evaluation.motion_differs = true;
    evaluation.notes.push_back(std::move(*doubt));
    return evaluation;
  }
  if (auto fault = evaluate_scenes(result, truth, echoes, options, evaluation)) return *fault;
  return evaluation;
}

}  // namespace slammot::evaluator
