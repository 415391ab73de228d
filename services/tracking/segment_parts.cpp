#include "services/tracking/segment_parts.hpp"

#include <algorithm>
#include <cmath>

#include "services/tracking/association.hpp"
#include "services/tracking/association_cost.hpp"

namespace slammot::tracking {
namespace {

using Eigen::Vector2d;
using flow::PointLabel;
using flow::Segment;

/// Margin around a predicted extent within which points may belong to it.
double margin_of(const Track& track, const TrackingConfig& config) {
  const double sigma_m = std::sqrt(0.5 * track.kinematics.position_covariance_m2().trace());
  return config.association.gate_margin_m + std::min(1.0, sigma_m);
}

/// True if the ends and the middle of the segment lie in the box.
bool lies_in_box(const Segment& segment, const Track& track, const ScanContext& context) {
  if (segment.box_length_m >
      track.footprint().length.value_m + context.config.association.gate_margin_m)
    return false;
  const double margin_m = margin_of(track, context.config);
  const auto contains = [&](const Vector2d& point_m) {
    return is_inside(track.footprint(), track.position_m(), margin_m, point_m);
  };
  return contains(segment.centroid_in_odom_m) &&
         contains(context.view.point_in_odom_m(segment.beams.front())) &&
         contains(context.view.point_in_odom_m(segment.beams.back()));
}

/// True if the segment may be another leg of a pedestrian.
bool is_leg(const Segment& segment, const Track& track, const TrackingConfig& config) {
  return track.extent.box() == nullptr && segment.box_length_m < config.extent.stride_m &&
         track.extent.largest_span_m < 2.0 * config.extent.stride_m &&
         (segment.centroid_in_odom_m - track.position_m()).norm() < config.extent.stride_m;
}

bool is_part(const Segment& segment, const Track& track, const ScanContext& context) {
  return track.extent.box() != nullptr ? lies_in_box(segment, track, context)
                                       : is_leg(segment, track, context.config);
}

/// Distance from the track's centre in widths.
double relative_distance(const Vector2d& point_m, const Track& track) {
  return (point_m - track.position_m()).norm() / std::max(0.3, track.footprint().width.value_m);
}

/// Removes the beams from all shares but one.
void remove_from_others(Associations& associations, std::size_t owner) {
  const std::vector<std::uint16_t>& beams = associations.shares[owner].beams;
  for (std::size_t other = 0; other < associations.shares.size(); ++other) {
    std::vector<std::uint16_t>& theirs = associations.shares[other].beams;
    if (other != owner)
      std::erase_if(theirs, [&](std::uint16_t beam) {
        return std::binary_search(beams.begin(), beams.end(), beam);
      });
  }
}

/// True if the track may take the echo of a segment from its owner, if it has one.
bool may_take(std::size_t segment, const Vector2d& point_m, const Track& track,
              const std::vector<Track>& tracks, const ComparedScan& context,
              const Associations& associations) {
  if (associations.is_unassigned(segment))
    return !has_other_past(context.scan().segments[segment], context.comparison.segment(segment),
                           track, context);
  return relative_distance(point_m, tracks[associations.track_of_segment[segment]]) >
         relative_distance(point_m, track);
}

}  // namespace

void assign_parts(const std::vector<Track>& tracks, const ComparedScan& context,
                  Associations& associations) {
  const std::vector<Segment>& segments = context.scan().segments;
  for (std::size_t s = 0; s < segments.size(); ++s) {
    if (!associations.is_unassigned(s) || is_backdrop(segments[s], context.config)) continue;
    for (std::size_t t = 0; t < tracks.size(); ++t) {
      if (tracks[t].history.is_hidden || !is_part(segments[s], tracks[t], context) ||
          has_other_past(segments[s], context.comparison.segment(s), tracks[t], context))
        continue;
      associations.track_of_segment[s] = t;
      break;
    }
  }
}

void divide_shared_segments(const std::vector<Track>& tracks, const ComparedScan& context,
                            Associations& associations) {
  const ScanView& view = context.view;
  for (std::size_t t = 0; t < tracks.size(); ++t) {
    const Track& track = tracks[t];
    if (associations.has_echoes(t) || !track.existence.confirmed || track.history.is_hidden)
      continue;
    const double margin_m = margin_of(track, context.config);
    const ScanView::Directions directions =
        view.directions_of(track.footprint(), track.position_m(), margin_m);
    TrackShare& share = associations.shares[t];
    PointLabel label = PointLabel::kUnknown;
    for (std::size_t i = 0; i < directions.count; ++i) {
      const std::size_t beam = *view.polar().neighbour_of(directions.first, static_cast<long>(i));
      const std::size_t s = view.segment_of_beam(beam);
      if (s == ScanView::kNone) continue;
      const Vector2d& point_m = view.point_in_odom_m(beam);
      if (!is_inside(track.footprint(), track.position_m(), margin_m, point_m)) continue;
      if (!may_take(s, point_m, track, tracks, context, associations)) continue;
      share.beams.push_back(static_cast<std::uint16_t>(beam));
      label = stronger(label, view.scan().segments[s].label);
    }
    std::sort(share.beams.begin(), share.beams.end());
    remove_from_others(associations, t);
    share.label = label;
  }
}

}  // namespace slammot::tracking
