#include "services/evaluator/annotations.hpp"

#include <algorithm>
#include <cmath>
#include <map>

namespace slammot::evaluator {
namespace {

constexpr std::int64_t kLongestGapNs = 1'000'000'000;
constexpr std::int64_t kLongestScanGapNs = 500'000'000;

struct Sighting {
  std::int64_t stamp_ns = 0;   ///< Of the annotated scan.
  metrics::TrueObject person;  ///< In the map.
};

/// Sightings of each person, by time. An annotation between two scans belongs to the earlier one.
std::map<std::size_t, std::vector<Sighting>> sightings_in_map(
    const std::vector<ObjectsAt>& annotated, const RunResult& result) {
  std::map<std::size_t, std::vector<Sighting>> sightings;
  for (const ObjectsAt& at : annotated) {
    const auto next =
        std::ranges::upper_bound(result.online, at.stamp_ns, {}, &metrics::StampedPose::stamp_ns);
    if (next == result.online.begin()) continue;
    const metrics::StampedPose& scan = *std::prev(next);
    if (at.stamp_ns - scan.stamp_ns > kLongestScanGapNs) continue;
    for (metrics::TrueObject person : at.objects) {
      person.world_from_object = scan.pose * result.base_from_laser * person.world_from_object;
      std::vector<Sighting>& of_person = sightings[person.object];
      if (of_person.empty() || of_person.back().stamp_ns < scan.stamp_ns)
        of_person.push_back({scan.stamp_ns, person});
    }
  }
  return sightings;
}

/// Slope of the line fitted to the sightings within one second. The difference of two annotations
/// alone would turn an error of a decimetre into a speed.
geometry::Vector2 velocity_at(const std::vector<Sighting>& sightings, std::int64_t stamp_ns) {
  double count = 0.0;
  double mean_s = 0.0;
  geometry::Vector2 mean_m = geometry::Vector2::Zero();
  const auto is_near = [&](const Sighting& sighting) {
    return std::abs(sighting.stamp_ns - stamp_ns) <= kLongestGapNs;
  };
  const auto time_s = [&](const Sighting& sighting) {
    return 1e-9 * static_cast<double>(sighting.stamp_ns - stamp_ns);
  };
  for (const Sighting& sighting : sightings) {
    if (!is_near(sighting)) continue;
    count += 1.0;
    mean_s += (time_s(sighting) - mean_s) / count;
    mean_m += (sighting.person.world_from_object.translation_m() - mean_m) / count;
  }
  double variance_s2 = 0.0;
  geometry::Vector2 covariance_ms = geometry::Vector2::Zero();
  for (const Sighting& sighting : sightings) {
    if (!is_near(sighting)) continue;
    const double off_s = time_s(sighting) - mean_s;
    variance_s2 += off_s * off_s;
    covariance_ms += off_s * (sighting.person.world_from_object.translation_m() - mean_m);
  }
  return variance_s2 > 0.0 ? geometry::Vector2(covariance_ms / variance_s2)
                           : geometry::Vector2::Zero();
}

std::optional<metrics::TrueObject> person_at(const std::vector<Sighting>& sightings,
                                             std::int64_t stamp_ns) {
  auto after = std::ranges::lower_bound(sightings, stamp_ns, {}, &Sighting::stamp_ns);
  if (after == sightings.end()) return std::nullopt;
  if (after == sightings.begin()) {
    if (after->stamp_ns != stamp_ns || sightings.size() < 2) return std::nullopt;
    ++after;
  }
  const auto before = std::prev(after);
  const std::int64_t gap_ns = after->stamp_ns - before->stamp_ns;
  if (gap_ns > kLongestGapNs) return std::nullopt;
  const geometry::Vector2 from_m = before->person.world_from_object.translation_m();
  const geometry::Vector2 way_m = after->person.world_from_object.translation_m() - from_m;
  const geometry::Vector2 place_m = from_m + static_cast<double>(stamp_ns - before->stamp_ns) /
                                                 static_cast<double>(gap_ns) * way_m;
  metrics::TrueObject person = before->person;
  const geometry::Vector2 velocity_mps = velocity_at(sightings, stamp_ns);
  person.world_from_object = {place_m.x(), place_m.y(),
                              std::atan2(velocity_mps.y(), velocity_mps.x())};
  person.speed_mps = velocity_mps.norm();
  return person;
}

bool is_seen_at(const std::vector<Sighting>& sightings, std::int64_t stamp_ns) {
  return std::ranges::binary_search(sightings, stamp_ns, {}, &Sighting::stamp_ns);
}

}  // namespace

Truth place_annotations(const Truth& truth, const RunResult& result, int points) {
  const auto sightings = sightings_in_map(*truth.annotated, result);
  Truth placed = truth;
  placed.annotated.reset();
  placed.objects.emplace();
  std::int64_t first_ns = truth.annotated->back().stamp_ns;
  for (const auto& [index, seen] : sightings) first_ns = std::min(first_ns, seen.front().stamp_ns);
  for (const metrics::StampedPose& pose : result.online) {
    if (pose.stamp_ns < first_ns || pose.stamp_ns > truth.annotated->back().stamp_ns) continue;
    placed.trajectory.push_back(pose);
    ObjectsAt at{pose.stamp_ns, {}};
    for (const auto& [index, seen] : sightings) {
      if (auto person = person_at(seen, pose.stamp_ns)) {
        person->points = is_seen_at(seen, pose.stamp_ns) ? points : 0;
        at.objects.push_back(*person);
      }
    }
    if (!at.objects.empty()) placed.objects->push_back(std::move(at));
  }
  return placed;
}

}  // namespace slammot::evaluator
