#include "services/loop_closing/pyramid_cache.hpp"

#include <algorithm>

#include "common/geometry/displacement.hpp"

namespace slammot::loop_closing {
namespace {

constexpr std::size_t kMostPyramids = 64;
constexpr double kSameShapeCells = 0.25;  // Smaller relative motion of a target's members leaves
                                          // its grid unchanged.

std::vector<matching::TargetPoint> as_target_points(const std::vector<flow::Surfel>& surfels) {
  std::vector<matching::TargetPoint> points;
  points.reserve(surfels.size());
  for (const flow::Surfel& surfel : surfels) points.push_back({surfel.x_m, surfel.y_m, 1.0F});
  return points;
}

}  // namespace

bool PyramidCache::is_of(const Entry& entry, const Target& target, double cell_m) {
  return entry.pyramid->cell_m() == cell_m &&
         std::ranges::equal(entry.members, target.members,
                            [&](const auto& known, const Target::Member& member) {
                              const Eigen::Vector3d moved =
                                  geometry::difference(known.second, member.target_from_member);
                              return known.first == member.place->id &&
                                     geometry::as_seen_10_m_away(moved) < kSameShapeCells * cell_m;
                            });
}

PyramidCache::Pyramid PyramidCache::pyramid_of(const Target& target, double cell_m) {
  ++uses_;
  const auto known = std::ranges::find_if(
      entries_, [&](const Entry& entry) { return is_of(entry, target, cell_m); });
  if (known != entries_.end()) {
    known->used = uses_;
    return {known->pyramid};
  }
  if (entries_.size() >= kMostPyramids)
    entries_.erase(std::ranges::min_element(entries_, {}, &Entry::used));
  Entry entry{.used = uses_};
  for (const Target::Member& member : target.members)
    entry.members.emplace_back(member.place->id, member.target_from_member);
  constexpr int kLevels = 6;
  entry.pyramid = std::make_shared<const matching::ScorePyramid>(
      as_target_points(surfels_in_target(target)), cell_m, cell_m, kLevels);
  entries_.push_back(entry);
  return {entry.pyramid, entry.pyramid->work()};
}

}  // namespace slammot::loop_closing
