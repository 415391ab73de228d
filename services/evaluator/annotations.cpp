#include "services/evaluator/annotations.hpp"

#include <algorithm>
#include <cmath>
#include <map>

namespace slammot::evaluator {
namespace {

constexpr std::int64_t kLongestGapNs = 1'000'000'000;
constexpr std::int64_t kLongestPoseGapNs = 500'000'000;

struct Sighting {
  std::int64_t stamp_ns = 0;
  metrics::TrueObject person;          ///< In the map.
};

/// Each person's sightings, by time.
std::map<std::size_t, std::vector<Sighting>> sightings_in_map(const std::vector<ObjectsAt>& annotated, const RunResult& result) {
  std::map<std::size_t, std::vector<Sighting>> sightings;
  for (const ObjectsAt& at : annotated) {
    const auto map_from_base = metrics::pose_at(result.online, at.stamp_ns, kLongestPoseGapNs);
    if (!map_from_base) continue;
    for (metrics::TrueObject person : at.objects) {
      person.world_from_object = *map_from_base * result.base_from_laser * person.world_from_object;
      sightings[person.object].push_back({at.stamp_ns, person});
    }
  }
  return sightings;
}

std::optional<metrics::TrueObject> person_at(const std::vector<Sighting>& sightings, std::int64_t stamp_ns) {
  const auto after = std::ranges::lower_bound(sightings, stamp_ns, {}, &Sighting::stamp_ns);
  if (after == sightings.begin() || after == sightings.end()) return std::nullopt;
  const auto before = std::prev(after);
  const std::int64_t gap_ns = after->stamp_ns - before->stamp_ns;
  if (gap_ns > kLongestGapNs) return std::nullopt;
  const geometry::Vector2 from_m = before->person.world_from_object.translation_m();
  const geometry::Vector2 way_m = after->person.world_from_object.translation_m() - from_m;
  const geometry::Vector2 place_m = from_m + static_cast<double>(stamp_ns - before->stamp_ns) / static_cast<double>(gap_ns) * way_m;
  metrics::TrueObject person = before->person;
  person.world_from_object = {place_m.x(), place_m.y(), std::atan2(way_m.y(), way_m.x())};
  person.speed_mps = way_m.norm() / (1e-9 * static_cast<double>(gap_ns));
  return person;
}

}  // namespace

Truth place_annotations(const Truth& truth, const RunResult& result, int points) {
  const auto sightings = sightings_in_map(*truth.annotated, result);
  Truth placed = truth;
  placed.annotated.reset();
  placed.objects.emplace();
  for (const metrics::StampedPose& pose : result.online) {
    if (pose.stamp_ns < truth.annotated->front().stamp_ns || pose.stamp_ns > truth.annotated->back().stamp_ns) continue;
    placed.trajectory.push_back(pose);
    ObjectsAt at{pose.stamp_ns, {}};
    for (const auto& [index, seen] : sightings) {
      if (auto person = person_at(seen, pose.stamp_ns)) {
        person->points = points;
        at.objects.push_back(*person);
      }
    }
    if (!at.objects.empty()) placed.objects->push_back(std::move(at));
  }
  return placed;
}

}  // namespace slammot::evaluator
