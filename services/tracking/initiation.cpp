#include "services/tracking/initiation.hpp"

#include <algorithm>

#include "common/sensing/box_fit.hpp"
#include "services/tracking/association_cost.hpp"
#include "services/tracking/beam_run.hpp"
#include "services/tracking/observing.hpp"
#include "services/tracking/track_initiation.hpp"

namespace slammot::tracking {
namespace {

using Eigen::Matrix2d;
using Eigen::Vector2d;
using flow::PointLabel;
using flow::Segment;

constexpr std::size_t kFewestFirstEchoes = 2;  ///< A single echo has no extent.

bool is_in_confirmed_vehicle(const Segment& segment, const std::vector<Track>& tracks,
                             const Associations& associations, const TrackingConfig& config) {
  for (std::size_t t = 0; t < tracks.size(); ++t)
    if (tracks[t].existence.confirmed && is_vehicle(tracks[t]) && associations.has_echoes(t) &&
        is_inside(tracks[t].footprint(), tracks[t].position_m(), config.association.gate_margin_m,
                  segment.centroid_in_odom_m))
      return true;
  return false;
}

/// True if enough of the segment arrived or receded.
bool has_changed(const Segment& segment, const SegmentComparison& comparison,
                 const TrackingConfig& config) {
  constexpr int kFewest = 4;
  constexpr double kLeastFaceShare = 0.15;
  constexpr double kLeastFlankShare = 0.3;
  const auto count = static_cast<int>(segment.beams.size());
  const bool has_flank =
      may_have_flank(segment, config) && comparison.stood > kLeastFlankShare * count;
  if (has_flank && comparison.longest_arrival >= kFewest &&
      comparison.longest_arrival >= kLeastFaceShare * count)
    return true;
  if (only_people_move(config) && segment.box_length_m < config.extent.stride_m &&
      comparison.came == count)
    return true;  // a leg sends few echoes
  const int moved = comparison.arrived + comparison.receded;
  return moved >= kFewest && moved > 0.6 * count &&
         segment.box_length_m < config.extent.longest_body_m;
}

}  // namespace

bool may_initiate(std::size_t index, const std::vector<Track>& tracks,
                  const Associations& associations, const ComparedScan& context) {
  if (!associations.is_unassigned(index)) return false;
  const Segment& segment = context.scan().segments[index];
  const SegmentComparison& of_segment = context.comparison.segment(index);
  if (segment.beams.size() < kFewestFirstEchoes) return false;
  if (is_in_confirmed_vehicle(segment, tracks, associations, context.config)) return false;
  if (!of_segment.face_shift_m.isZero()) return true;
  if (segment.label == PointLabel::kMoving) return !of_segment.stood_before;
  return has_changed(segment, of_segment, context.config);
}

void initiate_from_segment(Track& track, TrackShare& share, const Initiation& initiation,
                           const ComparedScan& context) {
  const ScanView& view = context.view;
  const TrackingConfig& config = context.config;
  const Segment& segment = view.scan().segments[initiation.segment];
  share.beams = segment.beams;
  share.label = segment.label;
  const ResponseRate responses =
      with_responses({}, segment.beams.size(), gaps_between(segment.beams, view.polar()), 0.0);
  const double time_offset_s = view.polar().delay_towards_s(segment.centroid_in_odom_m);
  const Observation observation =
      observe(share, {time_offset_s, Vector2d::Zero()}, responses, context);
  const Matrix2d pose_covariance_m2 = pose_covariance_at(segment.centroid_in_odom_m, view.scan());
  // Detection fits boxes to moving segments only.
  const double heading_rad =
      segment.label == PointLabel::kMoving
          ? segment.box_heading_rad
          : sensing::fit_box(share.points_m, config.sensor.range_noise_m).heading_rad;
  initiate(
      track,
      {initiation.track_id, view.scan().stamp_ns, observation, heading_rad, pose_covariance_m2},
      config, initiation.road_users);
  track.kinematics.time_offset_s = time_offset_s;
  track.extent.responses = responses;
  track.existence.mean_echoes = static_cast<double>(segment.beams.size());
  track.history.birth.centre_m -=
      context.comparison.segment(initiation.segment).face_shift_m;  // where it was when it was
                                                                    // first seen
  track.history.scanner = initiation.scanner;
  track.history.observations.add(view.scan().stamp_ns + nanoseconds(time_offset_s), observation,
                                 pose_covariance_m2);
}

}  // namespace slammot::tracking
