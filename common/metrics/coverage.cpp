#include "common/metrics/coverage.hpp"

#include <algorithm>

namespace slammot::metrics {
namespace {

Eigen::MatrixXd similarities(const std::vector<const TrueObject*>& objects, const Scene& scene,
                             const CountingRule& rule) {
  Eigen::MatrixXd similarity(objects.size(), scene.tracks.size());
  for (std::size_t row = 0; row < objects.size(); ++row) {
    for (std::size_t column = 0; column < scene.tracks.size(); ++column) {
      const double distance_m =
          distance_to_box_m(scene.tracks[column].world_from_object.translation_m(), *objects[row]);
      similarity(static_cast<Eigen::Index>(row), static_cast<Eigen::Index>(column)) =
          distance_m > rule.gate_m ? 0.0 : 1.0 - distance_m / rule.similarity_reach_m;
    }
  }
  return similarity;
}

}  // namespace

std::vector<const TrueObject*> all_objects(const Scene& scene) {
  std::vector<const TrueObject*> objects;
  for (const TrueObject& object : scene.hidden_objects) objects.push_back(&object);
  for (const TrueObject& object : scene.objects) {
    if (object.points > 0 || std::ranges::find(scene.hidden_objects, object.object,
                                               &TrueObject::object) == scene.hidden_objects.end())
      objects.push_back(&object);
  }
  return objects;
}

bool is_at(const ReportedTrack& track, const TrueObject& object, const CountingRule& rule) {
  return distance_to_box_m(track.world_from_object.translation_m(), object) <= rule.gate_m;
}

Timelines covered_timelines(const std::vector<Scene>& scenes, const CountingRule& rule) {
  Timelines timelines;
  for (std::size_t scan = 0; scan < scenes.size(); ++scan) {
    const Scene& scene = scenes[scan];
    const std::vector<const TrueObject*> objects = all_objects(scene);
    for (const TrueObject* object : objects)
      timelines[object->object].push_back({scan, object, std::nullopt});
    for (const auto& [row, column] : best_pairs(similarities(objects, scene, rule)))
      timelines[objects[row]->object].back().track = scene.tracks[column].track;
  }
  return timelines;
}

}  // namespace slammot::metrics
