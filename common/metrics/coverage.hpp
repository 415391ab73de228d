#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <vector>

#include "common/metrics/scene.hpp"

namespace slammot::metrics {

/// An object in one scan, and the track that covers it there.
struct CoveredMoment {
  std::size_t scan = 0;               ///< Index of the scene.
  const TrueObject* truth = nullptr;  ///< Refers to the scene.
  std::optional<std::size_t> track;   ///< ReportedTrack::track.
};

/// By TrueObject::object; moments ascend.
using Timelines = std::map<std::size_t, std::vector<CoveredMoment>>;

/// Pairs all objects of each scene, hidden ones too, with the tracks that are not reported as
/// occluded, by similarity within the gate. Refers to the scenes.
Timelines covered_timelines(const std::vector<Scene>& scenes, const CountingRule& rule);

/// All objects of the scene, each once: a hidden one as Scene::hidden_objects has it, else as
/// Scene::objects has it. Refers to the scene.
std::vector<const TrueObject*> all_objects(const Scene& scene);

/// True if the track's position is within the gate of the object's box.
bool is_at(const ReportedTrack& track, const TrueObject& object, const CountingRule& rule);

}  // namespace slammot::metrics
