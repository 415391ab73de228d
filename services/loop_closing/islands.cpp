#include "services/loop_closing/islands.hpp"

#include <algorithm>

namespace slammot::loop_closing {
namespace {

using flow::SubmapId;

SubmapId earliest_of(const std::map<SubmapId, SubmapId>& tied_to, SubmapId id) {
  while (tied_to.at(id) != id) id = tied_to.at(id);
  return id;
}

}  // namespace

std::map<SubmapId, SubmapId> islands(const std::vector<flow::CorrectedSubmap>& submaps,
                                     std::span<const flow::Constraint> constraints) {
  std::map<SubmapId, SubmapId> tied_to;
  for (const flow::CorrectedSubmap& submap : submaps) tied_to[submap.submap_id] = submap.submap_id;
  for (const flow::Constraint& constraint : constraints) {
    const SubmapId a = earliest_of(tied_to, constraint.from);
    const SubmapId b = earliest_of(tied_to, constraint.to);
    tied_to[std::max(a, b)] = std::min(a, b);
  }
  // Ids ascend: the submap that this one is tied to is resolved already.
  for (auto& [id, earlier] : tied_to) earlier = tied_to.at(earlier);
  return tied_to;
}

}  // namespace slammot::loop_closing
