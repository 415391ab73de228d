#include "common/city_model/mover_boxes.hpp"

#include <algorithm>
#include <cmath>

namespace slammot::city_model {
namespace {

double seconds(std::int64_t from_ns, std::int64_t to_ns) {
  return static_cast<double>(to_ns - from_ns) * 1e-9;
}

TrackedBox moved_on(TrackedBox box, std::int64_t stamp_ns) {
  const geometry::Vector2 moved_m = seconds(box.stamp_ns, stamp_ns) * box.velocity_in_map_mps;
  box.map_from_object.x_m += moved_m.x();
  box.map_from_object.y_m += moved_m.y();
  box.stamp_ns = stamp_ns;
  return box;
}

/// The larger size of both.
TrackedBox between(const TrackedBox& before, const TrackedBox& after, std::int64_t stamp_ns) {
  const double span_s = seconds(before.stamp_ns, after.stamp_ns);
  const double fraction = span_s > 0.0 ? seconds(before.stamp_ns, stamp_ns) / span_s : 0.0;
  TrackedBox box = before;
  box.stamp_ns = stamp_ns;
  box.map_from_object =
      geometry::interpolate(before.map_from_object, after.map_from_object, fraction);
  box.length_m = std::max(before.length_m, after.length_m);
  box.width_m = std::max(before.width_m, after.width_m);
  return box;
}

}  // namespace

std::vector<TrackedBox> MoverBoxes::at(std::int64_t stamp_ns) const {
  std::vector<TrackedBox> boxes;
  for (const auto& [id, track] : tracks_) {
    const bool is_over = seconds(track.back().stamp_ns, stamp_ns) > reach_.after_s;
    if (is_over || seconds(stamp_ns, track.front().stamp_ns) > reach_.before_s) continue;
    const auto after = std::ranges::lower_bound(track, stamp_ns, {}, &TrackedBox::stamp_ns);
    boxes.push_back(after == track.end()     ? moved_on(track.back(), stamp_ns)
                    : after == track.begin() ? moved_on(track.front(), stamp_ns)
                                             : between(*(after - 1), *after, stamp_ns));
    boxes.back().length_m += 2.0 * reach_.margin_m;
    boxes.back().width_m += 2.0 * reach_.margin_m;
  }
  return boxes;
}

bool contains(const TrackedBox& box, const geometry::Vector2& point_in_map_m) {
  const geometry::Vector2 in_object = geometry::inverse(box.map_from_object) * point_in_map_m;
  return std::abs(in_object.x()) <= 0.5 * box.length_m &&
         std::abs(in_object.y()) <= 0.5 * box.width_m;
}

}  // namespace slammot::city_model
