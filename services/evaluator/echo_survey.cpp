#include "services/evaluator/echo_survey.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <unordered_set>
#include <utility>

#include "common/metrics/outline_seen.hpp"
#include "services/evaluator/stamps.hpp"

namespace slammot::evaluator {
namespace {

using metrics::Scene;

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

/// Adds the echoes of a scan to the outlines of its moving objects, and notes in the scene how much
/// of each is seen by then.
void note_outlines(const EchoesInWorld& scan, const std::vector<metrics::BeamTruth>& beams,
                   metrics::OutlinesSeen& outlines, Scene& scene) {
  for (std::size_t beam = 0; beam < beams.size(); ++beam) {
    if (beams[beam].kind != metrics::BeamKind::kMoving) continue;
    const auto object =
        std::ranges::find(scene.objects, beams[beam].object, &metrics::TrueObject::object);
    if (object != scene.objects.end()) outlines.add(*object, *scan.points_m[beam]);
  }
  for (metrics::TrueObject& object : scene.objects) object.outline_seen = outlines.share_of(object);
}

}  // namespace

files::Result<EchoSurvey> survey_echoes(const EchoSource& echoes, const RunResult& result,
                                        std::vector<Scene>& scenes, const Truth& truth,
                                        const EchoSurveyOptions& options) {
  EchoSurvey survey;
  if (!echoes) return survey;
  if (truth.objects && !result.labels.empty()) survey.detection.emplace();
  SubsampledPoints walls(options.spacing_m);
  SubsampledPoints objects(options.spacing_m);
  metrics::OutlinesSeen outlines;
  const auto least_points = static_cast<std::size_t>(options.rule.least_points);
  const auto fault = echoes([&](const EchoesInWorld& scan) {
    const Scene* const scene = at_stamp(scenes, scan.stamp_ns, kSameStampNs);
    if (!scene) return;
    const auto beams = truth_of_beams(scan, truth, *scene, options.rule);
    note_outlines(scan, beams, outlines, scenes[static_cast<std::size_t>(scene - scenes.data())]);
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

}  // namespace slammot::evaluator
