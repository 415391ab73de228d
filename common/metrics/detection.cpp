#include "common/metrics/detection.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include "common/metrics/share.hpp"

namespace slammot::metrics {
namespace {

constexpr double kOnObjectM = 0.3;  // range noise, and motion of the object during the sweep
constexpr double kOffObjectM = 1.0;

struct Candidate {
  std::size_t beam = 0;
  double distance_m = 0.0;
};

struct Judged {
  BeamTruth truth;
  double distance_m = 0.0;  // to the box
};

Judged judge(const geometry::Vector2& point_m, const Scene& scene, const CountingRule& rule) {
  if ((point_m - scene.world_from_base.translation_m()).norm() > rule.range_m)
    return {{BeamKind::kDontCare}};
  double nearest_m = std::numeric_limits<double>::infinity();
  const TrueObject* nearest = nullptr;
  for (const TrueObject& object : scene.objects) {
    const double distance_m = distance_to_box_m(point_m, object);
    if (distance_m >= nearest_m) continue;
    nearest_m = distance_m;
    nearest = &object;
  }
  if (nearest_m > kOffObjectM) return {{BeamKind::kStationary}};
  if (nearest_m > kOnObjectM) return {{BeamKind::kDontCare}};
  if (std::abs(nearest->speed_mps) < rule.least_speed_mps) return {{BeamKind::kStanding}};
  return {{BeamKind::kMoving, nearest->object}, nearest_m};
}

BeamTruth judge(const BeamHit& hit, const Scene& scene, const CountingRule& rule) {
  if (hit.on == BeamHit::On::kNothing) return {};
  if (hit.on == BeamHit::On::kStationary) return {BeamKind::kStationary};
  const auto object = std::ranges::find(scene.objects, hit.object, &TrueObject::object);
  if (hit.on == BeamHit::On::kSeveral || object == scene.objects.end())
    return {BeamKind::kDontCare};
  return {
      std::abs(object->speed_mps) < rule.least_speed_mps ? BeamKind::kStanding : BeamKind::kMoving,
      hit.object};
}

/// The truth has the number of echoes of an object: of more echoes near its box, the farthest ones
/// may be of the background.
void doubt_surplus(const Scene& scene, std::map<std::size_t, std::vector<Candidate>> candidates,
                   std::vector<BeamTruth>& truth) {
  for (const TrueObject& object : scene.objects) {
    std::vector<Candidate>& beams = candidates[object.object];
    std::stable_sort(beams.begin(), beams.end(), [](const Candidate& a, const Candidate& b) {
      return a.distance_m < b.distance_m;
    });
    for (std::size_t i = static_cast<std::size_t>(std::max(object.points, 0)); i < beams.size();
         ++i)
      truth[beams[i].beam].kind = BeamKind::kDontCare;
  }
}

void count_points(const std::vector<BeamTruth>& truth, std::string_view labels,
                  DetectionCounts& counts) {
  for (std::size_t beam = 0; beam < truth.size(); ++beam) {
    const bool is_moving = truth[beam].kind == BeamKind::kMoving;
    if (!is_moving && truth[beam].kind != BeamKind::kStationary) continue;
    switch (labels[beam]) {
      case 'm': ++(is_moving ? counts.moving_as_moving : counts.stationary_as_moving); break;
      case 's':
        ++(is_moving ? counts.moving_as_stationary : counts.stationary_as_stationary);
        break;
      case '?': ++(is_moving ? counts.moving_as_unknown : counts.stationary_as_unknown); break;
      default: break;
    }
  }
}

void count_objects(const std::vector<BeamTruth>& truth, std::string_view labels,
                   std::size_t least_points, DetectionCounts& counts) {
  struct Points {
    std::size_t all = 0, moving = 0, stationary = 0;
  };
  std::map<std::size_t, Points> points_of_object;
  for (std::size_t beam = 0; beam < truth.size(); ++beam) {
    if (truth[beam].kind != BeamKind::kMoving) continue;
    Points& points = points_of_object[truth[beam].object];
    ++points.all;
    points.moving += labels[beam] == 'm' ? 1 : 0;
    points.stationary += labels[beam] == 's' ? 1 : 0;
  }
  for (const auto& [object, points] : points_of_object) {
    if (points.all < least_points) continue;
    ++counts.objects;
    counts.detected_objects += points.moving > points.stationary ? 1 : 0;
  }
}

void count_runs(const std::vector<BeamTruth>& truth, std::string_view labels,
                std::size_t least_points, DetectionCounts& counts) {
  for (std::size_t begin = 0; begin < truth.size();) {
    if (labels[begin] != 'm') {
      ++begin;
      continue;
    }
    std::size_t end = begin;
    std::size_t moving = 0;
    std::size_t stationary = 0;
    for (; end < truth.size() && labels[end] == 'm'; ++end) {
      moving += truth[end].kind == BeamKind::kMoving ? 1 : 0;
      stationary += truth[end].kind == BeamKind::kStationary ? 1 : 0;
    }
    const bool counts_at_all =
        end - begin >= least_points && 2 * (moving + stationary) > end - begin;
    begin = end;
    if (!counts_at_all) continue;
    ++counts.moving_runs;
    counts.right_runs += moving > stationary ? 1 : 0;
  }
}

}  // namespace

double DetectionCounts::moving_precision() const {
  return share(moving_as_moving, moving_as_moving + stationary_as_moving);
}
double DetectionCounts::moving_recall() const {
  return share(moving_as_moving, moving_as_moving + moving_as_stationary + moving_as_unknown);
}
double DetectionCounts::stationary_precision() const {
  return share(stationary_as_stationary, stationary_as_stationary + moving_as_stationary);
}
double DetectionCounts::stationary_recall() const {
  return share(stationary_as_stationary,
               stationary_as_stationary + stationary_as_moving + stationary_as_unknown);
}
double DetectionCounts::segment_precision() const { return share(right_runs, moving_runs); }
double DetectionCounts::segment_recall() const { return share(detected_objects, objects); }

std::vector<BeamTruth> beam_truth(
    const std::vector<std::optional<geometry::Vector2>>& points_in_world_m, const Scene& scene,
    const CountingRule& rule) {
  std::vector<BeamTruth> truth;
  truth.reserve(points_in_world_m.size());
  std::map<std::size_t, std::vector<Candidate>> candidates;
  for (std::size_t beam = 0; beam < points_in_world_m.size(); ++beam) {
    const Judged judged =
        points_in_world_m[beam] ? judge(*points_in_world_m[beam], scene, rule) : Judged{};
    truth.push_back(judged.truth);
    if (judged.truth.kind == BeamKind::kMoving)
      candidates[judged.truth.object].push_back({beam, judged.distance_m});
  }
  doubt_surplus(scene, std::move(candidates), truth);
  return truth;
}

std::vector<BeamTruth> beam_truth(
    const std::vector<std::optional<geometry::Vector2>>& points_in_world_m,
    const std::vector<BeamHit>& hits, const Scene& scene, const CountingRule& rule) {
  std::vector<BeamTruth> truth(points_in_world_m.size());
  for (std::size_t beam = 0; beam < truth.size(); ++beam) {
    if (!points_in_world_m[beam]) continue;
    const bool is_far =
        (*points_in_world_m[beam] - scene.world_from_base.translation_m()).norm() > rule.range_m;
    truth[beam] = is_far ? BeamTruth{BeamKind::kDontCare} : judge(hits[beam], scene, rule);
  }
  return truth;
}

DetectionCounts add_scan(DetectionCounts counts, const std::vector<BeamTruth>& truth,
                         std::string_view labels, std::size_t least_points) {
  if (labels.size() != truth.size()) return counts;
  count_points(truth, labels, counts);
  count_objects(truth, labels, least_points, counts);
  count_runs(truth, labels, least_points, counts);
  return counts;
}

}  // namespace slammot::metrics
