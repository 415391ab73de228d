#include "services/tracking/labelling.hpp"

namespace slammot::tracking {
namespace {

using flow::PointLabel;
using flow::Segment;

void label_segment(const Segment& segment, const SegmentComparison& comparison,
                   std::vector<PointLabel>& labels) {
  for (const std::uint16_t beam : segment.beams) {
    // A single contradiction in a stationary segment is an error of the map, which then learns.
    if (segment.label == PointLabel::kStationary && labels[beam] == PointLabel::kMoving)
      labels[beam] = PointLabel::kStationary;
    if (comparison.has_come) labels[beam] = PointLabel::kMoving;
    else if (segment.label == PointLabel::kMoving)
      labels[beam] = comparison.stood_before ? PointLabel::kStationary : PointLabel::kMoving;
  }
}

}  // namespace

void label_beams(const std::vector<Track>& tracks, const Associations& associations,
                 const ComparedScan& context, std::vector<PointLabel>& labels) {
  const std::vector<Segment>& segments = context.scan().segments;
  for (std::size_t s = 0; s < segments.size(); ++s)
    label_segment(segments[s], context.comparison.segment(s), labels);
  for (std::size_t t = 0; t < tracks.size(); ++t)
    if (tracks[t].existence.confirmed)
      for (const std::uint16_t beam : associations.shares[t].beams)
        labels[beam] = PointLabel::kMoving;
}

void find_owners(const std::vector<Track>& tracks, const Associations& associations,
                 const ComparedScan& context, std::vector<Owner>& owners) {
  owners.assign(context.scan().range_m.size(), {});
  for (std::size_t t = 0; t < tracks.size(); ++t) {
    const bool is_confirmed = tracks[t].existence.confirmed;
    for (const std::uint16_t beam : associations.shares[t].beams)
      owners[beam] = {tracks[t].track_id, true, is_confirmed,
                      is_confirmed && tracks[t].extent.box() != nullptr};
  }
  for (std::size_t s = 0; s < context.comparison.segment_count(); ++s) {
    if (!context.comparison.segment(s).has_come) continue;
    for (const std::uint16_t beam : context.scan().segments[s].beams) owners[beam].has_come = true;
  }
}

void keep_points(Track& track, const std::vector<std::uint16_t>& beams, std::size_t scanner,
                 const ComparedScan& context) {
  constexpr std::size_t kMostScans = 64;
  if (track.existence.confirmed || beams.empty()) return;
  memory::RecyclingQueue<PastPoints>& past_points = track.history.past_points;
  if (past_points.size() == kMostScans) past_points.pop_front();
  PastPoints& past = past_points.push_back();
  past.scanner = scanner;
  past.points.sequence = context.scan().sequence;
  past.points.beams = beams;
  std::erase_if(past.points.beams, [&](std::uint16_t beam) {
    return context.comparison.segment(context.view.segment_of_beam(beam)).has_come;
  });
}

}  // namespace slammot::tracking
