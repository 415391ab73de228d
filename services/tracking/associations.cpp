#include "services/tracking/associations.hpp"

#include <algorithm>

namespace slammot::tracking {

using flow::PointLabel;

void clear(Associations& associations, std::size_t segment_count) {
  for (TrackShare& share : associations.shares) {
    share.beams.clear();
    share.label = PointLabel::kUnknown;
  }
  associations.track_of_segment.assign(segment_count, association::kUnassigned);
}

void add_beams(std::vector<std::uint16_t>& beams, std::span<const std::uint16_t> more) {
  beams.insert(beams.end(), more.begin(), more.end());
  std::sort(beams.begin(), beams.end());
}

void release(Associations& associations, std::size_t track) {
  associations.shares[track].beams.clear();
  std::replace(associations.track_of_segment.begin(), associations.track_of_segment.end(), track,
               association::kUnassigned);
}

void move_beams(Associations& associations, std::size_t from, std::size_t to) {
  add_beams(associations.shares[to].beams, associations.shares[from].beams);
  associations.shares[from].beams.clear();
}

PointLabel stronger(PointLabel a, PointLabel b) {
  for (const PointLabel label : {PointLabel::kMoving, PointLabel::kStationary})
    if (a == label || b == label) return label;
  return PointLabel::kUnknown;
}

}  // namespace slammot::tracking
