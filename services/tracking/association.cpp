#include "services/tracking/association.hpp"

#include <algorithm>
#include <cmath>

#include "services/tracking/association_cost.hpp"
#include "services/tracking/segment_parts.hpp"

namespace slammot::tracking {
namespace {

using association::kForbidden;
using association::kUnassigned;
using Eigen::Vector2d;
using flow::PointLabel;
using flow::Segment;

bool is_slow(const Track& track) { return track.velocity_mps().norm() < 1.5; }

/// Forbids a segment to all tracks.
void forbid_column(association::CostMatrix& costs, std::size_t column) {
  for (std::size_t row = 0; row < costs.rows; ++row) costs(row, column) = kForbidden;
}

void forbid_row(association::CostMatrix& costs, std::size_t row) {
  for (std::size_t column = 0; column < costs.columns; ++column) costs(row, column) = kForbidden;
}

/// Gives each track the beams and labels of its segments.
void collect_beams(const ScanContext& context, Associations& associations) {
  const std::vector<Segment>& segments = context.scan().segments;
  for (std::size_t s = 0; s < segments.size(); ++s) {
    if (associations.is_unassigned(s)) continue;
    TrackShare& share = associations.shares[associations.track_of_segment[s]];
    add_beams(share.beams, segments[s].beams);
    share.label = stronger(share.label, segments[s].label);
  }
}

}  // namespace

bool has_other_past(const Segment& segment, const SegmentComparison& comparison, const Track& track,
                    const ScanContext& context) {
  constexpr std::size_t kMostAsked = 7;
  // Much of a creeping vehicle slides along itself and seems to stand; a known pedestrian has no
  // such flank.
  const bool may_slide = track.extent.box() != nullptr || !track.existence.confirmed;
  if (!comparison.stands || (may_slide && is_slow(track))) return false;
  const EarlierScan* then = context.history.older_than(context.scan().stamp_ns, 0.0);
  if (then == nullptr) return false;
  const std::size_t stride = 1 + (segment.beams.size() - 1) / kMostAsked;
  int asked = 0;
  int own = 0;
  for (std::size_t i = 0; i < segment.beams.size(); i += stride) {
    const SightOfPlace before = then->view.sight_of(context.view.point_in_odom_m(segment.beams[i]));
    ++asked;
    if (before.sight != Sight::kThere) continue;
    const Owner& owner = then->owners[before.beam];
    own += owner.is_owned && owner.track_id == track.track_id ? 1 : 0;
  }
  return 2 * own < asked;
}

/// Gives the tracks that compete the segments of their likeliest hypothesis, and forbids these to
/// all others.
void Associator::assign_competing_tracks(std::vector<Track>& tracks, const ComparedScan& context,
                                         Associations& associations) {
  const auto is_allowed = [&](std::size_t track, std::size_t segment) {
    return !has_other_past(context.scan().segments[segment], context.comparison.segment(segment),
                           tracks[track], context);
  };
  const std::vector<std::size_t> segment_of_track =
      competing_tracks_.decide(tracks, context.view, is_allowed);
  for (std::size_t t = 0; t < tracks.size(); ++t) {
    if (!competing_tracks_.has(tracks[t])) continue;
    forbid_row(costs_, t);
    if (segment_of_track[t] == kUnassigned) continue;
    forbid_column(costs_, segment_of_track[t]);
    associations.track_of_segment[segment_of_track[t]] = t;
  }
}

void Associator::assign_whole_segments(std::vector<Track>& tracks, const ComparedScan& context,
                                       Associations& associations) {
  const std::vector<Segment>& segments = context.scan().segments;
  costs_.assign(tracks.size(), segments.size(), kForbidden);
  for (std::size_t t = 0; t < tracks.size(); ++t)
    for (std::size_t s = 0; s < segments.size() && !tracks[t].history.is_hidden; ++s) {
      const double cost = association_cost(tracks[t].extent.outline, tracks[t].kinematics.estimate,
                                           segments[s], context.config);
      if (cost != kForbidden &&
          !has_other_past(segments[s], context.comparison.segment(s), tracks[t], context))
        costs_(t, s) = cost;
    }
  if (context.config.association.most_hypotheses > 1)
    assign_competing_tracks(tracks, context, associations);
  const std::vector<std::size_t>& segment_of_track = assigner_.assign(costs_, kCostOfMiss);
  for (std::size_t t = 0; t < tracks.size(); ++t)
    if (segment_of_track[t] != kUnassigned) associations.track_of_segment[segment_of_track[t]] = t;
}

void Associator::associate(std::vector<Track>& tracks, const ComparedScan& context,
                           Associations& associations) {
  clear(associations, context.scan().segments.size());
  assign_whole_segments(tracks, context, associations);
  assign_parts(tracks, context, associations);
  collect_beams(context, associations);
  divide_shared_segments(tracks, context, associations);
}

}  // namespace slammot::tracking
