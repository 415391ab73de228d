#include "common/metrics/scene.hpp"

#include <algorithm>
#include <cmath>
#include <unordered_map>

namespace slammot::metrics {
namespace {

using geometry::Vector2;

Eigen::MatrixXd distances_m(const Scene& scene) {
  Eigen::MatrixXd distance_m(scene.objects.size(), scene.tracks.size());
  for (std::size_t row = 0; row < scene.objects.size(); ++row) {
    for (std::size_t column = 0; column < scene.tracks.size(); ++column) {
      distance_m(static_cast<Eigen::Index>(row), static_cast<Eigen::Index>(column)) =
          distance_to_box_m(scene.tracks[column].world_from_object.translation_m(),
                            scene.objects[row]);
    }
  }
  return distance_m;
}

Eigen::MatrixXd similarities(const Eigen::MatrixXd& distance_m, const CountingRule& rule) {
  return (1.0 - distance_m.array() / rule.similarity_reach_m).max(0.0).matrix();
}

std::vector<std::size_t> counted_objects(const Scene& scene, const CountingRule& rule) {
  std::vector<std::size_t> counted;
  for (std::size_t row = 0; row < scene.objects.size(); ++row) {
    if (does_count(scene.objects[row], scene, rule)) counted.push_back(row);
  }
  return counted;
}

std::vector<std::size_t> counted_tracks(const Scene& scene, const std::vector<std::size_t>& objects,
                                        const Eigen::MatrixXd& distance_m,
                                        const CountingRule& rule) {
  constexpr std::size_t kNobody = static_cast<std::size_t>(-1);
  const auto object_counts = [&](std::size_t row) {
    return std::binary_search(objects.begin(), objects.end(), row);
  };
  std::vector<std::size_t> partner(scene.tracks.size(), kNobody);
  const Eigen::MatrixXd score = similarities(distance_m, rule);
  const double least_similarity = 1.0 - rule.gate_m / rule.similarity_reach_m;
  for (const auto& [row, column] :
       best_pairs((score.array() >= least_similarity).select(score, 0.0)))
    partner[column] = row;
  std::vector<std::size_t> counted;
  for (std::size_t column = 0; column < scene.tracks.size(); ++column) {
    if (partner[column] != kNobody) {
      if (object_counts(partner[column])) counted.push_back(column);
      continue;
    }
    bool is_left_out = !is_in_view(scene.tracks[column].world_from_object, scene, rule);
    for (std::size_t row = 0; row < scene.objects.size() && !is_left_out; ++row) {
      is_left_out = !object_counts(row) &&
                    distance_m(static_cast<Eigen::Index>(row), static_cast<Eigen::Index>(column)) <=
                        rule.dont_care_margin_m;
    }
    if (!is_left_out) counted.push_back(column);
  }
  return counted;
}

TrueObject between(const TrueObject& before, const TrueObject& after, double fraction) {
  TrueObject hidden = before;
  hidden.world_from_object =
      geometry::interpolate(before.world_from_object, after.world_from_object, fraction);
  hidden.speed_mps = std::lerp(before.speed_mps, after.speed_mps, fraction);
  hidden.points = 0;
  return hidden;
}

struct LastSeen {
  std::size_t scene = 0;
  TrueObject object;
};

}  // namespace

double distance_to_box_m(const Vector2& point_in_world_m, const TrueObject& object) {
  const Vector2 in_object_m = geometry::inverse(object.world_from_object) * point_in_world_m;
  const double ahead_m = std::max(0.0, std::abs(in_object_m.x()) - 0.5 * object.length_m);
  const double aside_m = std::max(0.0, std::abs(in_object_m.y()) - 0.5 * object.width_m);
  return std::hypot(ahead_m, aside_m);
}

bool is_in_view(const geometry::Pose2& world_from_object, const Scene& scene,
                const CountingRule& rule) {
  const Vector2 in_base_m =
      geometry::inverse(scene.world_from_base) * world_from_object.translation_m();
  const double bearing_rad = std::atan2(in_base_m.y(), in_base_m.x());
  return in_base_m.norm() <= rule.range_m && bearing_rad >= rule.first_bearing_rad &&
         bearing_rad <= rule.last_bearing_rad;
}

bool does_count(const TrueObject& object, const Scene& scene, const CountingRule& rule) {
  return object.points >= rule.least_points && std::abs(object.speed_mps) >= rule.least_speed_mps &&
         is_in_view(object.world_from_object, scene, rule);
}

std::vector<Scene> fill_gaps(std::vector<Scene> scenes, std::int64_t longest_gap_ns) {
  std::unordered_map<std::size_t, LastSeen> last_seen;
  for (std::size_t now = 0; now < scenes.size(); ++now) {
    const std::vector<TrueObject> seen = scenes[now].objects;  // later insertions affect only
                                                               // earlier scenes
    for (const TrueObject& object : seen) {
      const auto before = last_seen.find(object.object);
      if (before != last_seen.end()) {
        const std::size_t then = before->second.scene;
        const std::int64_t gap_ns = scenes[now].stamp_ns - scenes[then].stamp_ns;
        for (std::size_t hidden = then + 1; hidden < now && gap_ns <= longest_gap_ns; ++hidden) {
          const double fraction =
              static_cast<double>(scenes[hidden].stamp_ns - scenes[then].stamp_ns) /
              static_cast<double>(gap_ns);
          scenes[hidden].objects.push_back(between(before->second.object, object, fraction));
        }
      }
      last_seen[object.object] = {now, object};
    }
  }
  return scenes;
}

CountedScene count_scene(const Scene& scene, const CountingRule& rule) {
  const Eigen::MatrixXd distance_m = distances_m(scene);
  CountedScene counted;
  counted.objects = counted_objects(scene, rule);
  counted.tracks = counted_tracks(scene, counted.objects, distance_m, rule);
  counted.distance_m = distance_m(counted.objects, counted.tracks);
  counted.frame.stamp_ns = scene.stamp_ns;
  counted.frame.similarity = similarities(counted.distance_m, rule);
  for (const std::size_t row : counted.objects)
    counted.frame.objects.push_back(scene.objects[row].object);
  for (const std::size_t column : counted.tracks)
    counted.frame.tracks.push_back(scene.tracks[column].track);
  return counted;
}

}  // namespace slammot::metrics
