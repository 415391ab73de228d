#include "services/evaluator/tracking_evaluation.hpp"

#include <set>

namespace slammot::evaluator {
namespace {

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

}  // namespace

TrackingEvaluation evaluate_tracking(const Scenes& scenes,
                                     const std::vector<metrics::CountedScene>& counted,
                                     std::size_t object_count, const metrics::CountingRule& rule) {
  metrics::MotSequence sequence{object_count, scenes.track_ids.size(), {}};
  std::set<std::size_t> objects;
  std::set<std::size_t> tracks;
  for (const metrics::CountedScene& scene : counted) {
    objects.insert(scene.frame.objects.begin(), scene.frame.objects.end());
    tracks.insert(scene.frame.tracks.begin(), scene.frame.tracks.end());
    sequence.frames.push_back(scene.frame);
  }
  const double least_similarity = 1.0 - rule.gate_m / rule.similarity_reach_m;
  TrackingEvaluation evaluation;
  evaluation.scans = scenes.scenes.size();
  evaluation.objects = objects.size();
  evaluation.tracks = tracks.size();
  evaluation.clear = metrics::clear_mot(sequence, least_similarity);
  evaluation.identity = metrics::identity(sequence, least_similarity);
  evaluation.hota = metrics::hota(sequence);
  evaluation.gospa = mean_gospa(counted, rule.similarity_reach_m);
  evaluation.errors = metrics::object_errors(scenes.scenes, counted, evaluation.clear,
                                             {0.0, 10.0, 20.0, 30.0, 40.0}, rule.range_m);
  evaluation.predictions =
      metrics::prediction_errors(scenes.scenes, counted, evaluation.clear.matches);
  evaluation.vehicle_boxes = metrics::vehicle_box_errors(scenes.scenes, counted, evaluation.clear);
  evaluation.strict_hota =
      metrics::strict_hota(scenes.scenes, counted, object_count, scenes.track_ids.size());
  evaluation.stopped = metrics::stopped_rows(scenes.scenes, rule);
  return evaluation;
}

}  // namespace slammot::evaluator
