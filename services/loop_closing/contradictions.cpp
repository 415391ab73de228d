#include "services/loop_closing/contradictions.hpp"

namespace slammot::loop_closing {
namespace {

using flow::SubmapId;
using geometry::Pose2;
using geometry::Vector2;

/// Nearest earlier place on the same island within half of max_distance_m; null if there is none.
const Place* nearest_earlier_place(const SubmapView& submaps, const Place& source) {
  const auto& [config, places, graph, gnss_is_sound] = submaps;
  const Vector2 in_map_m = graph.map_from_node(source.id) * source.centre_m;
  const Place* nearest = nullptr;
  double nearest_m = 0.5 * config.max_distance_m;
  for (const auto& [id, place] : places) {
    if (source.travelled_before_m - place.travelled_after_m < config.min_travel_between_m ||
        !graph.are_on_one_island(id, source.id))
      continue;
    const double distance_m = (graph.map_from_node(id) * place.centre_m - in_map_m).norm();
    if (distance_m >= nearest_m) continue;
    nearest_m = distance_m;
    nearest = &place;
  }
  return nearest;
}

}  // namespace

Agreement agreement_on(const SubmapView& submaps, SubmapId target_id, const Place& source) {
  const ClosureGraph& graph = submaps.graph;
  const Target target = target_around(submaps, target_id, source);
  const Pose2 target_from_source =
      geometry::inverse(graph.map_from_node(target_id)) * graph.map_from_node(source.id);
  return agreement_after_refining(submaps.config.revisit, target, source, target_from_source);
}

bool is_comparable(const Agreement& agreement) {
  constexpr double kLeastComparedShare = 0.4;  // Share of the source's walls that must be
                                               // comparable.
  return agreement.occupied_in_both + agreement.contradicted >
         kLeastComparedShare * agreement.source_walls;
}

bool contradicts(const Agreement& agreement) {
  constexpr double kMostAgreedShare = 0.6;
  return is_comparable(agreement) && agreement.agreed_share() < kMostAgreedShare;
}

bool contradicts(const SubmapView& submaps, SubmapId target, const Place& source) {
  return contradicts(agreement_on(submaps, target, source));
}

bool preceding_submaps_contradict(const SubmapView& submaps, SubmapId located) {
  constexpr std::uint32_t kBefore = 3;
  int compared = 0;
  int contradicting = 0;
  for (std::uint32_t step = 1; step <= kBefore && step <= located.value; ++step) {
    const auto found = submaps.places.find({located.value - step});
    if (found == submaps.places.end() || !submaps.graph.are_on_one_island(found->first, located))
      continue;
    const Place* const nearest = nearest_earlier_place(submaps, found->second);
    if (nearest == nullptr) continue;
    ++compared;
    if (contradicts(submaps, nearest->id, found->second)) ++contradicting;
  }
  return contradicting > 0 && 2 * contradicting >= compared;
}

}  // namespace slammot::loop_closing
