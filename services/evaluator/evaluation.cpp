#include "services/evaluator/evaluation.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <map>
#include <set>
#include <unordered_set>
#include <utility>

#include "services/evaluator/annotations.hpp"
#include "services/evaluator/table_file.hpp"

namespace slammot::evaluator {
namespace {

using files::Error;
using geometry::Pose2;
using metrics::PosePair;
using metrics::Scene;

template <typename... Values>
std::string text(const char* format, Values... values) {
  char line[512];
  std::snprintf(line, sizeof line, format, values...);
  return line;
}

double seconds(std::int64_t stamp_ns) { return static_cast<double>(stamp_ns) * 1e-9; }

std::vector<Pose2> true_poses(const std::vector<PosePair>& pairs) {
  std::vector<Pose2> poses;
  for (const PosePair& pair : pairs) poses.push_back(pair.truth);
  return poses;
}

std::vector<Pose2> estimated_poses(const std::vector<PosePair>& pairs) {
  std::vector<Pose2> poses;
  for (const PosePair& pair : pairs) poses.push_back(pair.estimate);
  return poses;
}

std::vector<double> translations_m(const std::vector<metrics::RelativeError>& errors) {
  std::vector<double> values;
  for (const auto& error : errors) values.push_back(error.translation_m);
  return values;
}

std::vector<double> rotations_rad(const std::vector<metrics::RelativeError>& errors) {
  std::vector<double> values;
  for (const auto& error : errors) values.push_back(error.rotation_rad);
  return values;
}

RelativeErrors relative(const std::vector<PosePair>& pairs, double delta_m) {
  const auto consecutive = metrics::relative_errors(
      pairs,
      metrics::pairs_by_path(estimated_poses(pairs), delta_m, metrics::PathPairs::kConsecutive));
  const auto all = metrics::relative_errors(
      pairs, metrics::pairs_by_path(true_poses(pairs), delta_m, metrics::PathPairs::kAll));
  return {delta_m, metrics::summarize(translations_m(consecutive)),
          metrics::summarize(translations_m(all)), metrics::summarize(rotations_rad(all))};
}

TrajectoryEvaluation evaluate_trajectory(const metrics::Trajectory& truth,
                                         const metrics::Trajectory& estimate,
                                         std::int64_t max_difference_ns) {
  TrajectoryEvaluation evaluation;
  evaluation.matched = metrics::associate(truth, estimate, max_difference_ns);
  evaluation.poses = estimate.size();
  evaluation.pairs = evaluation.matched.size();
  evaluation.world_from_map = metrics::align_rigidly(evaluation.matched);
  evaluation.absolute_m =
      metrics::summarize(metrics::absolute_errors_m(evaluation.matched, evaluation.world_from_map));
  evaluation.absolute_from_start_m = metrics::summarize(metrics::absolute_errors_m(
      evaluation.matched, metrics::align_first_pose(evaluation.matched)));
  for (const double delta_m : {1.0, 10.0, 100.0})
    evaluation.relative.push_back(relative(evaluation.matched, delta_m));
  return evaluation;
}

metrics::Trajectory without_loops(const RunResult& result) {
  metrics::Trajectory trajectory;
  for (const metrics::UncertainStampedPose& pose : result.uncertain)
    trajectory.push_back({pose.stamp_ns, pose.odom_from_base.pose});
  return trajectory;
}

std::string span_of(const metrics::Trajectory& trajectory) {
  return text("%.3f to %.3f s", seconds(trajectory.front().stamp_ns),
              seconds(trajectory.back().stamp_ns));
}

/// Fails if result and truth are of different drives or clocks: their relative motions then differ
/// by as much as their length.
std::optional<Error> fault_of_motion(const std::vector<PosePair>& pairs) {
  constexpr double kDeltaM = 10.0;
  constexpr double kMinDifferenceShare = 0.5;  // Systems with large drift stay below 0.02.
  constexpr std::size_t kMinPairs = 5;
  const auto ends =
      metrics::pairs_by_path(true_poses(pairs), kDeltaM, metrics::PathPairs::kConsecutive);
  if (ends.size() < kMinPairs) return std::nullopt;
  const double median_m =
      metrics::summarize(translations_m(metrics::relative_errors(pairs, ends))).median;
  if (median_m < kMinDifferenceShare * kDeltaM) return std::nullopt;
  return Error{
      text("the frames do not overlap: over 10 m of the true path the result has an error of %.1f "
           "m, so it is of another drive or its clock is shifted",
           median_m)};
}

std::optional<Error> fault_of_overlap(const RunResult& result, const Truth& truth,
                                      const std::vector<PosePair>& pairs) {
  constexpr std::size_t kMinPairs = 3;
  if (pairs.size() >= kMinPairs) return fault_of_motion(pairs);
  return Error{text(
      "the clocks do not overlap: %zu poses of the result (%s) have a true pose at their time (%s)",
      pairs.size(), span_of(result.online).c_str(), span_of(truth.trajectory).c_str())};
}

metrics::ReportedTrack in_world(const ResultTrack& track, std::size_t index,
                                const Pose2& world_from_map) {
  metrics::ReportedTrack reported;
  reported.track = index;
  reported.object_class = track.object_class;
  reported.world_from_object = world_from_map * track.map_from_object;
  const geometry::Matrix2 turn = geometry::rotation(world_from_map.heading_rad);
  reported.velocity_in_world_mps = turn * track.velocity_in_map_mps;
  reported.length_m = track.length_m;
  reported.width_m = track.width_m;
  reported.is_moving = track.is_moving;
  if (track.position_covariance_m2)
    reported.position_covariance_m2 = turn * *track.position_covariance_m2 * turn.transpose();
  for (const metrics::PredictedPlace& place : track.predicted_in_map)
    reported.predicted.push_back({place.after_s, world_from_map * place.position_m,
                                  turn * place.covariance_m2 * turn.transpose()});
  return reported;
}

/// Tolerance of stamps of one log, which may be rounded; less than the interval of scans.
constexpr std::int64_t kSameStampNs = 1'000'000;

/// The element with the nearest stamp, if the difference is within the tolerance; otherwise null.
/// Elements ascend.
template <typename Element>
const Element* at_stamp(const std::vector<Element>& elements, std::int64_t stamp_ns,
                        std::int64_t max_difference_ns) {
  auto after = std::lower_bound(
      elements.begin(), elements.end(), stamp_ns,
      [](const Element& element, std::int64_t stamp) { return element.stamp_ns < stamp; });
  if (after != elements.begin() &&
      (after == elements.end() ||
       stamp_ns - std::prev(after)->stamp_ns < after->stamp_ns - stamp_ns))
    --after;
  return after != elements.end() && std::abs(after->stamp_ns - stamp_ns) <= max_difference_ns
             ? &*after
             : nullptr;
}

struct Scenes {
  std::vector<Scene> scenes;
  std::vector<std::uint32_t> track_ids;
};

Scenes make_scenes(const RunResult& result, const Truth& truth, std::int64_t max_difference_ns) {
  constexpr std::int64_t kLongestTruthGapNs = 200'000'000;
  Scenes made;
  std::map<std::uint32_t, std::size_t> index_of_track;
  for (const metrics::StampedPose& online : result.online) {
    const auto world_from_base =
        metrics::pose_at(truth.trajectory, online.stamp_ns, kLongestTruthGapNs);
    if (!world_from_base) continue;
    Scene scene{online.stamp_ns, *world_from_base, {}, {}};
    if (truth.objects) {
      if (const ObjectsAt* at =
              at_stamp(*truth.objects, online.stamp_ns, std::min(max_difference_ns, kSameStampNs)))
        scene.objects = at->objects;
    }
    const Pose2 world_from_map = *world_from_base * geometry::inverse(online.pose);
    if (const TracksAt* at = at_stamp(result.tracks, online.stamp_ns, kSameStampNs)) {
      for (const ResultTrack& track : at->tracks) {
        const auto [known, is_new] =
            index_of_track.try_emplace(track.track_id, index_of_track.size());
        if (is_new) made.track_ids.push_back(track.track_id);
        const std::size_t index = known->second;
        scene.tracks.push_back(in_world(track, index, world_from_map));
      }
    }
    made.scenes.push_back(std::move(scene));
  }
  return made;
}

/// Greater than the range of any scanner.
constexpr double kMaxDistanceM = 500.0;

std::optional<Error> fault_of_objects(const std::vector<Scene>& scenes, bool has_objects) {
  double nearest_object_m = std::numeric_limits<double>::infinity();
  double nearest_track_m = std::numeric_limits<double>::infinity();
  bool has_rows = false;
  bool has_tracks = false;
  for (const Scene& scene : scenes) {
    const auto away_m = [&](const Pose2& pose) {
      return (pose.translation_m() - scene.world_from_base.translation_m()).norm();
    };
    for (const auto& object : scene.objects)
      nearest_object_m = std::min(nearest_object_m, away_m(object.world_from_object));
    for (const auto& track : scene.tracks)
      nearest_track_m = std::min(nearest_track_m, away_m(track.world_from_object));
    has_rows = has_rows || !scene.objects.empty();
    has_tracks = has_tracks || !scene.tracks.empty();
  }
  if (has_objects && !has_rows)
    return Error{"the clocks do not overlap: no scan of the result has true objects at its time"};
  if (has_rows && nearest_object_m > kMaxDistanceM)
    return Error{text(
        "the frames do not overlap: the nearest true object is %.0f m from the true trajectory",
        nearest_object_m)};
  if (has_tracks && nearest_track_m > kMaxDistanceM)
    return Error{
        text("the frames do not overlap: the nearest track is %.0f m from the online trajectory",
             nearest_track_m)};
  return std::nullopt;
}

MeanGospa mean_gospa(const std::vector<metrics::CountedScene>& counted, double cutoff_m) {
  MeanGospa mean;
  const double share = counted.empty() ? 0.0 : 1.0 / static_cast<double>(counted.size());
  for (const metrics::CountedScene& scene : counted) {
    const metrics::Gospa one = metrics::gospa(scene.distance_m, cutoff_m);
    mean.distance_m += share * one.distance_m;
    mean.localization_m2 += share * one.localization_m2;
    mean.missed_m2 += share * one.missed_m2;
    mean.false_tracks_m2 += share * one.false_tracks_m2;
  }
  return mean;
}

TrackingEvaluation evaluate_tracking(const std::vector<Scene>& scenes,
                                     const std::vector<metrics::CountedScene>& counted,
                                     std::size_t object_count, std::size_t track_count,
                                     const metrics::CountingRule& rule) {
  metrics::MotSequence sequence{object_count, track_count, {}};
  std::set<std::size_t> objects;
  std::set<std::size_t> tracks;
  for (const metrics::CountedScene& scene : counted) {
    objects.insert(scene.frame.objects.begin(), scene.frame.objects.end());
    tracks.insert(scene.frame.tracks.begin(), scene.frame.tracks.end());
    sequence.frames.push_back(scene.frame);
  }
  const double least_similarity = 1.0 - rule.gate_m / rule.similarity_reach_m;
  TrackingEvaluation evaluation;
  evaluation.scans = scenes.size();
  evaluation.objects = objects.size();
  evaluation.tracks = tracks.size();
  evaluation.clear = metrics::clear_mot(sequence, least_similarity);
  evaluation.identity = metrics::identity(sequence, least_similarity);
  evaluation.hota = metrics::hota(sequence);
  evaluation.gospa = mean_gospa(counted, rule.similarity_reach_m);
  evaluation.errors = metrics::object_errors(scenes, counted, evaluation.clear,
                                             {0.0, 10.0, 20.0, 30.0, 40.0}, rule.range_m);
  evaluation.predictions = metrics::prediction_errors(scenes, counted, evaluation.clear.matches);
  return evaluation;
}

metrics::OccupancyCells to_cells(const files::MapImage& image) {
  metrics::OccupancyCells cells{image.width,   image.height,  image.resolution_m,
                                image.min_x_m, image.min_y_m, {}};
  cells.state.reserve(image.pixels.size());
  for (std::size_t row = 0; row < image.height; ++row) {
    const auto first =
        image.pixels.begin() + static_cast<std::ptrdiff_t>((image.height - 1 - row) * image.width);
    for (auto pixel = first; pixel != first + static_cast<std::ptrdiff_t>(image.width); ++pixel) {
      cells.state.push_back(*pixel == files::kOccupiedPixel ? metrics::CellState::kOccupied
                            : *pixel == files::kFreePixel   ? metrics::CellState::kFree
                                                            : metrics::CellState::kUnknown);
    }
  }
  return cells;
}

/// Results of one pass over the echoes of the drive.
struct EchoSurvey {
  std::optional<DetectionEvaluation> detection;
  std::vector<geometry::Vector2> wall_points_m;  // in world; one point for each square with an echo
  std::vector<geometry::Vector2> object_points_m;
};

/// Subsamples points: the first one in each square of the given size.
class SubsampledPoints {
 public:
  explicit SubsampledPoints(double size_m) : size_m_(size_m) {}

  void add(const geometry::Vector2& point_m) {
    const auto x = static_cast<std::int64_t>(std::floor(point_m.x() / size_m_));
    const auto y = static_cast<std::int64_t>(std::floor(point_m.y() / size_m_));
    if (keys_.insert((static_cast<std::uint64_t>(x) << 32) + static_cast<std::uint64_t>(y)).second)
      points_m_.push_back(point_m);
  }
  std::vector<geometry::Vector2> take() { return std::move(points_m_); }

 private:
  double size_m_;
  std::unordered_set<std::uint64_t> keys_;
  std::vector<geometry::Vector2> points_m_;
};

/// Labels beams by the recorded hits, if available, otherwise by the position of the echoes.
std::vector<metrics::BeamTruth> truth_of_beams(const EchoesInWorld& scan, const Truth& truth,
                                               const Scene& scene,
                                               const metrics::CountingRule& rule) {
  const HitsAt* const at =
      truth.hits ? at_stamp(*truth.hits, scan.stamp_ns, kSameStampNs) : nullptr;
  if (!at) return metrics::beam_truth(scan.points_m, scene, rule);
  const std::vector<metrics::BeamHit> hits = at->hits();
  return hits.size() == scan.points_m.size() ? metrics::beam_truth(scan.points_m, hits, scene, rule)
                                             : metrics::beam_truth(scan.points_m, scene, rule);
}

files::Result<EchoSurvey> survey_echoes(const EchoSource& echoes, const RunResult& result,
                                        const std::vector<Scene>& scenes, const Truth& truth,
                                        const EvaluationOptions& options) {
  EchoSurvey survey;
  if (!echoes) return survey;
  if (truth.objects && !result.labels.empty()) survey.detection.emplace();
  SubsampledPoints walls(0.25 * options.map_tolerance_m);
  SubsampledPoints objects(0.25 * options.map_tolerance_m);
  const auto least_points = static_cast<std::size_t>(options.rule.least_points);
  const auto fault = echoes([&](const EchoesInWorld& scan) {
    const Scene* const scene = at_stamp(scenes, scan.stamp_ns, kSameStampNs);
    if (!scene) return;
    const auto beams = truth_of_beams(scan, truth, *scene, options.rule);
    for (std::size_t beam = 0; beam < beams.size(); ++beam) {
      if (beams[beam].kind == metrics::BeamKind::kStationary) walls.add(*scan.points_m[beam]);
      if (beams[beam].kind == metrics::BeamKind::kMoving ||
          beams[beam].kind == metrics::BeamKind::kStanding)
        objects.add(*scan.points_m[beam]);
    }
    const LabelsAt* const labels =
        survey.detection ? at_stamp(result.labels, scan.stamp_ns, kSameStampNs) : nullptr;
    if (!labels) return;
    ++survey.detection->scans;
    survey.detection->by_detection = metrics::add_scan(survey.detection->by_detection, beams,
                                                       labels->by_detection, least_points);
    survey.detection->by_tracking =
        metrics::add_scan(survey.detection->by_tracking, beams, labels->by_tracking, least_points);
  });
  if (fault) return *fault;
  survey.wall_points_m = walls.take();
  survey.object_points_m = objects.take();
  return survey;
}

OtherCarEvaluation evaluate_other_car(const std::vector<Scene>& scenes,
                                      const metrics::Trajectory& other_car) {
  constexpr double kGateM = 0.5;  // about the length of such a car
  constexpr std::int64_t kLongestTruthGapNs = 200'000'000;
  constexpr std::int64_t kDifferenceNs = 50'000'000;  // averages millimetres of noise of motion
                                                      // capture
  OtherCarEvaluation evaluation;
  std::vector<double> position_m;
  std::vector<double> velocity_mps;
  std::set<std::size_t> identities;
  std::optional<std::size_t> track_before;
  std::size_t false_tracks = 0;
  for (const Scene& scene : scenes) {
    const auto now = metrics::pose_at(other_car, scene.stamp_ns, kLongestTruthGapNs);
    const auto before =
        metrics::pose_at(other_car, scene.stamp_ns - kDifferenceNs, kLongestTruthGapNs);
    const auto after =
        metrics::pose_at(other_car, scene.stamp_ns + kDifferenceNs, kLongestTruthGapNs);
    if (!now || !before || !after) continue;
    ++evaluation.scans;
    const metrics::ReportedTrack* match = nullptr;
    const auto away_m = [&](const metrics::ReportedTrack& track) {
      return (track.world_from_object.translation_m() - now->translation_m()).norm();
    };
    for (const metrics::ReportedTrack& track : scene.tracks) {
      if (away_m(track) > kGateM) continue;
      const bool continues = track_before && track.track == *track_before;
      if (!match || continues || (match->track != track_before && away_m(track) < away_m(*match)))
        match = &track;
    }
    for (const metrics::ReportedTrack& track : scene.tracks)
      false_tracks += track.is_moving && &track != match ? 1 : 0;
    if (!match) continue;
    ++evaluation.matched_scans;
    track_before = match->track;
    identities.insert(match->track);
    position_m.push_back(away_m(*match));
    const geometry::Vector2 true_velocity_mps = (after->translation_m() - before->translation_m()) /
                                                (2e-9 * static_cast<double>(kDifferenceNs));
    velocity_mps.push_back((match->velocity_in_world_mps - true_velocity_mps).norm());
  }
  evaluation.identities = identities.size();
  evaluation.position_m = metrics::summarize(position_m);
  evaluation.velocity_mps = metrics::summarize(velocity_mps);
  if (evaluation.scans > 0)
    evaluation.false_moving_tracks_a_scan =
        static_cast<double>(false_tracks) / static_cast<double>(evaluation.scans);
  return evaluation;
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
  if (auto fault = fault_of_overlap(result, truth, evaluation.online.matched)) return *fault;
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
  evaluation.track_ids = std::move(made.track_ids);
  evaluation.scenes =
      metrics::fill_gaps(std::move(made.scenes), to_ns(options.longest_occlusion_s));
  auto survey = survey_echoes(echoes, result, evaluation.scenes, truth, options);
  if (!survey) return survey.error();
  evaluation.detection = survey->detection;
  if (truth.other_car)
    evaluation.other_car = evaluate_other_car(evaluation.scenes, *truth.other_car);
  if (truth.objects) {
    for (const Scene& scene : evaluation.scenes)
      evaluation.counted.push_back(metrics::count_scene(scene, options.rule));
    evaluation.tracking =
        evaluate_tracking(evaluation.scenes, evaluation.counted, truth.object_count,
                          evaluation.track_ids.size(), options.rule);
  }
  if (truth.walls && result.map) {
    evaluation.map =
        metrics::map_quality(to_cells(*result.map), evaluation.corrected.world_from_map,
                             {*truth.walls, moving_objects(truth, options.rule.least_speed_mps),
                              survey->wall_points_m, survey->object_points_m},
                             options.map_tolerance_m);
  }
  add_notes(result, truth, echoes, evaluation);
  return std::nullopt;
}

}  // namespace

std::vector<PosePair> localized_in_world(const RunResult& result,
                                         const TrajectoryEvaluation& trajectory) {
  std::vector<PosePair> pairs;
  for (const PosePair& pair : trajectory.matched) {
    const bool was_localized =
        result.uncertain.empty() || at_stamp(result.uncertain, pair.stamp_ns, kSameStampNs);
    if (was_localized)
      pairs.push_back({pair.stamp_ns, pair.truth, trajectory.world_from_map * pair.estimate});
  }
  return pairs;
}

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
  if (auto fault = evaluate_scenes(result, truth, echoes, options, evaluation)) return *fault;
  return evaluation;
}

}  // namespace slammot::evaluator
