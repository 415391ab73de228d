#include "services/loop_closing/map_merge.hpp"

#include <algorithm>
#include <numbers>
#include <set>

#include "common/graphs/path_uncertainty.hpp"
#include "services/loop_closing/contradictions.hpp"
#include "services/loop_closing/islands.hpp"
#include "services/loop_closing/loop_closer.hpp"

namespace slammot::loop_closing {
namespace {

using flow::Constraint;
using flow::Submap;
using flow::SubmapId;
using geometry::Pose2;
using geometry::UncertainPose2;
using geometry::Vector2;

constexpr int kNeededPlaces = 3;                  // Submaps of the second map with a closure.
constexpr double kMostContradictingShare = 0.25;  // Of the overlapping submaps.

/// No drive waits for the result: every submap is searched for in the whole map.
LoopClosingConfig without_hurry(LoopClosingConfig config, std::size_t submaps) {
  constexpr double kWork = 2e9;  // Cells read for one submap.
  config.search = {.work_per_submap = kWork,
                   .work_per_search = kWork,
                   .work_at_end = kWork,
                   .most_waiting = 64,
                   .patience = static_cast<int>(submaps)};
  config.most_targets_elsewhere = static_cast<int>(submaps);
  return config;
}

UncertainPose2 unknown_pose() {
  constexpr double kSigma_m = 1000.0;
  return {Pose2::identity(), Eigen::Vector3d(kSigma_m * kSigma_m, kSigma_m * kSigma_m,
                                             std::numbers::pi * std::numbers::pi)
                                 .asDiagonal()};
}

/// Both sequences, numbered from 0; the second begins an island.
std::vector<Submap> in_sequence(const std::vector<Submap>& first,
                                const std::vector<Submap>& second) {
  std::vector<Submap> all = first;
  all.insert(all.end(), second.begin(), second.end());
  for (std::size_t i = 0; i < all.size(); ++i) {
    all[i].map_id = {};
    all[i].submap_id = {static_cast<std::uint32_t>(i)};
  }
  all[first.size()].previous_from_submap = unknown_pose();
  return all;
}

bool is_active(const Constraint& constraint) {
  return constraint.verdict.state == flow::ClosureState::kAccepted;
}

std::vector<Constraint> active(std::vector<Constraint> constraints) {
  std::erase_if(constraints, [](const Constraint& one) { return !is_active(one); });
  return constraints;
}

bool are_connected(const Merge& merge, SubmapId a, SubmapId b) {
  const auto island_of = islands(merge.correction.submaps, active(merge.constraints));
  return island_of.at(a) == island_of.at(b);
}

void count_closures(SubmapId begin, Merge& merge) {
  std::set<SubmapId> places;
  merge.closures = 0;
  for (const Constraint& one : merge.constraints) {
    if (one.kind != flow::ConstraintKind::kLoop || !is_active(one) || one.from >= begin ||
        one.to < begin)
      continue;
    ++merge.closures;
    places.insert(one.to);
  }
  merge.places = static_cast<int>(places.size());
}

/// Nearest submap of the first map; null if none is within half of max_distance_m.
const Place* nearest_of_first(const SubmapView& submaps, const Place& source, SubmapId begin) {
  const Vector2 in_map_m = submaps.graph.map_from_node(source.id) * source.centre_m;
  const Place* nearest = nullptr;
  double nearest_m = 0.5 * submaps.config.max_distance_m;
  for (const auto& [id, place] : submaps.places) {
    if (id >= begin) break;
    const double distance_m = (submaps.graph.map_from_node(id) * place.centre_m - in_map_m).norm();
    if (distance_m >= nearest_m || !submaps.graph.are_on_one_island(id, source.id)) continue;
    nearest_m = distance_m;
    nearest = &place;
  }
  return nearest;
}

/// Compares all submaps of the second map with the first one at their common poses: a false join
/// fits where it was found and nowhere else.
void compare_walls(const SubmapView& submaps, SubmapId begin, Merge& merge) {
  Agreement all;
  for (auto source = submaps.places.lower_bound(begin); source != submaps.places.end(); ++source) {
    const Place* const nearest = nearest_of_first(submaps, source->second, begin);
    if (nearest == nullptr) continue;
    const Agreement agreement = agreement_on(submaps, nearest->id, source->second);
    if (!is_comparable(agreement)) continue;
    ++merge.overlapping;
    merge.contradicting += contradicts(agreement) ? 1 : 0;
    all.occupied_in_both += agreement.occupied_in_both;
    all.contradicted += agreement.contradicted;
  }
  merge.agreed_share = all.agreed_share();
}

MergeOutcome outcome_of(const Merge& merge) {
  if (merge.places < kNeededPlaces) return MergeOutcome::kTooFewPlaces;
  if (merge.contradicting > kMostContradictingShare * merge.overlapping)
    return MergeOutcome::kContradicted;
  return MergeOutcome::kJoined;
}

/// Ties the second map's first submap to the submap before it by the pose that was found, so that a
/// graph that is built again from the submaps needs no search.
void tie(SubmapId begin, Merge& merge) {
  const SubmapId last{begin.value - 1};
  UncertainPose2 tied = graphs::poses_along_best_paths(last, active(merge.constraints)).at(begin);
  tied.pose = geometry::inverse(merge.correction.submaps[last.value].map_from_submap) *
              merge.correction.submaps[begin.value].map_from_submap;
  const Pose2 odom_from_other_odom = merge.submaps[last.value].odom_from_submap * tied.pose *
                                     geometry::inverse(merge.submaps[begin.value].odom_from_submap);
  merge.submaps[begin.value].previous_from_submap = tied;
  for (std::size_t i = begin.value; i < merge.submaps.size(); ++i)
    merge.submaps[i].odom_from_submap = odom_from_other_odom * merge.submaps[i].odom_from_submap;
}

}  // namespace

Merge merge_maps(const LoopClosingConfig& config, const std::vector<Submap>& first,
                 const std::vector<Submap>& second) {
  const SubmapId begin{static_cast<std::uint32_t>(first.size())};
  Merge merge;
  merge.submaps = in_sequence(first, second);
  LoopCloser closer(without_hurry(config, merge.submaps.size()));
  for (const Submap& submap : merge.submaps) closer.add(submap);
  const auto update = [&](const flow::GraphCorrection& correction) {
    merge.correction = correction;
    merge.constraints = closer.constraints();
    merge.counters = closer.counters();
  };
  update(closer.finish());
  if (!are_connected(merge, {0}, begin)) return merge;
  update(closer.search_again(begin));
  count_closures(begin, merge);
  compare_walls(closer.submaps(), begin, merge);
  merge.outcome =
      are_connected(merge, {0}, begin) ? outcome_of(merge) : MergeOutcome::kNoCommonPlace;
  if (merge.outcome == MergeOutcome::kJoined) tie(begin, merge);
  return merge;
}

}  // namespace slammot::loop_closing
