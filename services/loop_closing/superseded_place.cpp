#include "services/loop_closing/superseded_place.hpp"

#include <vector>

namespace slammot::loop_closing {
namespace {

constexpr std::size_t kFirst = 4;     // Places that are kept of those around one spot,
constexpr std::size_t kLatest = 8;    // and these of the latest ones: both directions, often.
constexpr double kAroundShare = 0.5;  // Distance of the centres, by the way of a submap.

}  // namespace

std::optional<flow::SubmapId> superseded_place(const SubmapView& submaps, const Place& newest) {
  const double around_m = kAroundShare * (newest.travelled_after_m - newest.travelled_before_m);
  const geometry::Vector2 centre_m = submaps.graph.map_from_node(newest.id) * newest.centre_m;
  std::vector<flow::SubmapId> around;
  for (const auto& [id, place] : submaps.places) {
    const geometry::Vector2 apart_m = submaps.graph.map_from_node(id) * place.centre_m - centre_m;
    if (!place.is_superseded && apart_m.norm() < around_m &&
        submaps.graph.are_on_one_island(id, newest.id))
      around.push_back(id);
  }
  if (around.size() <= kFirst + kLatest) return std::nullopt;
  return around[kFirst];
}

}  // namespace slammot::loop_closing
