#include "services/tracking/observing.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "common/sensing/box_fit.hpp"
#include "services/tracking/beam_run.hpp"

namespace slammot::tracking {
namespace {

using Eigen::Vector2d;
using flow::Segment;

/// Mean distance of the segment's echoes from the sides of its fitted box.
double distance_from_sides_m(const Segment& segment, const ScanView& view) {
  const sensing::BoxSides sides(sensing::OrientedBox{segment.box_centre_in_odom_m,
                                                     segment.box_heading_rad, segment.box_length_m,
                                                     segment.box_width_m});
  double sum_m = 0.0;
  for (const std::uint16_t beam : segment.beams)
    sum_m += sides.distance_m(view.point_in_odom_m(beam));
  return sum_m / static_cast<double>(segment.beams.size());
}

/// The long side of the segment that has most of the beams, if it has one.
std::optional<Side> side_of(const std::vector<std::uint16_t>& beams, const ScanView& view,
                            double least_length_m) {
  constexpr std::size_t kFewestEchoes = 6;
  const Segment& segment = view.scan().segments[view.segment_of_beam(beams[beams.size() / 2])];
  if (segment.beams.size() < kFewestEchoes || segment.box_length_m < least_length_m ||
      2 * segment.beams.size() < beams.size())
    return std::nullopt;
  const bool is_line = segment.box_width_m < 0.1 * segment.box_length_m;
  if (segment.label != flow::PointLabel::kMoving && !is_line)
    return std::nullopt;  // detection fits headings to moving segments only
  return Side{segment.box_heading_rad, segment.box_length_m, distance_from_sides_m(segment, view)};
}

}  // namespace

SweptMotion swept_motion(const Track& track) {
  return {track.kinematics.time_offset_s, track.velocity_mps()};
}

Observation observe(TrackShare& share, const SweptMotion& motion, const ResponseRate& responses,
                    const ScanContext& context) {
  constexpr double kLongSideM = 1.4;
  const ScanView& view = context.view;
  const double size_scale = context.config.extent.size_scale;
  const std::vector<std::uint16_t>& beams = share.beams;
  share.points_m.clear();
  const BeamRun run = run_of(beams, view.polar());
  for (std::size_t i = 0; i < beams.size(); ++i) {
    const std::uint16_t beam = beams[(run.start + i) % beams.size()];
    share.points_m.push_back(view.point_in_odom_m(beam) -
                             (view.polar().delay_s(beam) - motion.time_offset_s) *
                                 motion.velocity_mps);
  }
  return {share.points_m,
          view.laser_in_odom_m(),
          view.beam_step_rad(),
          edge_beyond(view, run.first, -1, size_scale),
          edge_beyond(view, run.last, +1, size_scale),
          side_of(beams, view, kLongSideM * size_scale),
          responses.unanswered_share()};
}

void predict_to_beam(Track& track, double time_s, const PolarView& view,
                     const TrackingConfig& config) {
  double& time_offset_s = track.kinematics.time_offset_s;
  const double before_s = time_offset_s;
  const double beam_s =
      view.delay_towards_s(track.position_m() + (time_s - before_s) * track.velocity_mps());
  time_offset_s = std::max(beam_s, before_s - time_s);
  predict(track, std::max(0.0, time_s + time_offset_s - before_s), config);
  track.history.since_in_view_s += time_s;
}

std::int64_t nanoseconds(double time_s) { return std::llround(time_s / 1e-9); }

}  // namespace slammot::tracking
