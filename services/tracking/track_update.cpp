#include "services/tracking/track_update.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "services/tracking/association_cost.hpp"
#include "services/tracking/beam_run.hpp"
#include "services/tracking/confirmation.hpp"
#include "services/tracking/existence_score.hpp"
#include "services/tracking/extent_update.hpp"
#include "services/tracking/measurement_update.hpp"
#include "services/tracking/motion_evidence.hpp"
#include "services/tracking/observing.hpp"
#include "services/tracking/refiltering.hpp"
#include "services/tracking/velocity_check.hpp"

namespace slammot::tracking {
namespace {

using Eigen::Matrix2d;

/// Removes echoes from the share of a long known pedestrian that has suddenly become large: the
/// rest is a wall or a companion.
void keep_pedestrian_echoes(Track& track, std::vector<std::uint16_t>& beams, double time_s,
                            const ScanContext& context) {
  constexpr int kLongKnownHits = 20;
  constexpr double kBelievedAfterS = 0.5;
  const ScanView& view = context.view;
  const TrackingConfig& config = context.config;
  const bool is_known = is_known_pedestrian(track);
  const bool is_likely = is_known || (track.existence.confirmed && track.extent.box() == nullptr &&
                                      track.existence.hits >= kLongKnownHits &&
                                      track.velocity_mps().norm() < kFastestWalkMps);
  if (!is_likely || beams.empty()) return;
  const auto is_near = [&](std::uint16_t beam) {
    return (view.point_in_odom_m(beam) - track.position_m()).norm() <
           config.extent.stride_m + (is_known ? 0.0 : config.association.gate_margin_m);
  };
  const BeamRun run = run_of(beams, view.polar());
  const bool is_oversized =
      (view.point_in_odom_m(run.last) - view.point_in_odom_m(run.first)).norm() >
      config.extent.box_from_extent_m;
  double& oversized_s = track.extent.misfit.oversized_s;
  oversized_s = is_oversized ? oversized_s + time_s : 0.0;
  if (!is_oversized || (!is_known && oversized_s > kBelievedAfterS) ||
      std::ranges::none_of(beams, is_near))
    return;
  std::erase_if(beams, [&](std::uint16_t beam) { return !is_near(beam); });
}

/// Updates the track if the echoes are its own. Rejected once they may be another object's;
/// rejected again and again, the extent is wrong and is re-initialised.
bool accepts(Track& track, const Observation& observation, flow::PointLabel label, double time_s,
             const ScanContext& context) {
  constexpr double kKnownToMoveM = 5.0;
  constexpr double kWrongAfterS = 0.1;
  constexpr std::size_t kFewestEchoes = 6;
  const TrackingConfig& config = context.config;
  const std::int64_t stamp_ns = context.scan().stamp_ns;
  const Matrix2d pose_covariance_m2 = pose_covariance_at(track.position_m(), context.scan());
  double& rejected_s = track.extent.misfit.rejected_s;
  if (!update(track, stamp_ns, observation, pose_covariance_m2, config)) {
    rejected_s += time_s;
    const bool surely_moves =
        label == flow::PointLabel::kMoving &&
        track.existence.travel.travelled_m > kKnownToMoveM * config.extent.size_scale;
    const bool may_be_redrawn =
        track.extent.box() != nullptr && observation.points_m.size() >= kFewestEchoes;
    if (!may_be_redrawn || !surely_moves || rejected_s < kWrongAfterS) return false;
    reinitialise_extent(track, observation, config);
    if (!update(track, stamp_ns, observation, pose_covariance_m2, config)) return false;
  }
  rejected_s = 0.0;
  return true;
}

void update_existence(Track& track, const TrackShare& share, double time_s,
                      const ComparedScan& context) {
  const TrackingConfig& config = context.config;
  Existence& existence = track.existence;
  if (!existence.confirmed)
    existence.tentative = with_echoes(existence.tentative, share.beams, context);
  score_hit(track, {share.label, motion_evidence(track, share.beams, context), time_s}, config);
  if (!existence.confirmed || !is_vehicle(track)) return;
  const Visibility interior = context.view.visibility_of(interior_of(track), track.position_m());
  score_passed(track, interior, share.beams.size());
  existence.passage = with_beams(existence.passage, interior.passed, share.beams.size(), time_s);
}

/// Filters a confirmable track again by its present extent. Kept if it is still confirmable, or
/// surely turned by a quarter: otherwise it lacks only certainty.
void refilter(Track& track, const TrackingConfig& config) {
  const Belief before = belief_of(track);
  set_belief(track, refiltered(track, config));
  const bool was_turned =
      std::abs(std::sin(footprint_of(before.outline).heading_rad - track.footprint().heading_rad)) >
      0.7;
  const bool is_surely_turned = was_turned && track.extent.box()->is_oriented;
  if (!is_surely_turned && !is_confirmable(track, config)) set_belief(track, before);
}

/// Stores the observation of a tentative track, and re-initialises or refilters it where that may
/// let it be confirmed.
void prepare_confirmation(Track& track, const Observation& observation, double time_s,
                          const ScanContext& context) {
  if (track.existence.confirmed) return;
  const std::int64_t stamp_ns =
      context.scan().stamp_ns + nanoseconds(track.kinematics.time_offset_s);
  track.history.observations.add(stamp_ns, observation,
                                 pose_covariance_at(track.position_m(), context.scan()));
  reinitialise_extent_if_misfit(track, observation, time_s, context.config);
  if (is_confirmable(track, context.config)) refilter(track, context.config);
}

/// Checks the velocity where that is due; true if the track can be confirmed.
bool passes_velocity_check(Track& track, const Observation& observation, bool is_known_again,
                           const ScanContext& context) {
  constexpr int kHitsBetweenChecks = 5;
  const bool is_candidate = !track.existence.confirmed && is_confirmable(track, context.config);
  if (is_candidate || is_known_again ||
      (track.existence.confirmed && track.existence.hits % kHitsBetweenChecks == 0))
    check_velocity(track, observation, context);
  return is_candidate && !track.existence.velocity_check.is_refuted &&
         is_confirmable(track, context.config);
}

/// False for a track without echoes that this scan cannot see and another scanner has in its field
/// of view: that one's scans tell.
bool is_concerned(Track& track, const TrackShare& share, const ScanContext& context,
                  const CurrentScanner& scanner) {
  if (scanner.is_only_one) return true;
  const Visibility visibility = context.view.visibility_of(track.footprint(), track.position_m());
  if (share.beams.empty() && visibility.beams == 0 && track.history.scanner != scanner.index)
    return false;
  if (!share.beams.empty() || visibility.beams > 0) track.history.scanner = scanner.index;
  return true;
}

void count_echoes(Track& track, std::size_t echoes, double time_s) {
  constexpr double kMemoryS = 0.2;
  double& mean_echoes = track.existence.mean_echoes;
  mean_echoes += (1.0 - std::exp(-time_s / kMemoryS)) * (static_cast<double>(echoes) - mean_echoes);
}

}  // namespace

UpdateOutcome update_track(Track& track, TrackShare& share, const ComparedScan& context,
                           const CurrentScanner& scanner) {
  const ScanView& view = context.view;
  const TrackingConfig& config = context.config;
  if (!is_concerned(track, share, context, scanner)) return UpdateOutcome::kContinues;
  const double time_s = std::exchange(track.history.since_in_view_s, 0.0);
  keep_pedestrian_echoes(track, share.beams, time_s, context);
  count_echoes(track, share.beams.size(), time_s);
  track.history.misses = share.beams.empty() ? track.history.misses + 1 : 0;
  if (share.beams.empty() && track.history.is_unseen) {
    score_unseen(track, time_s);
    return UpdateOutcome::kContinues;
  }
  if (share.beams.empty()) {
    score_miss(track, view.visibility_of(track.footprint(), track.position_m()), time_s, config);
    return UpdateOutcome::kContinues;
  }
  track.extent.responses = with_responses(track.extent.responses, share.beams.size(),
                                          gaps_between(share.beams, view.polar()), time_s);
  const Observation observation =
      observe(share, swept_motion(track), track.extent.responses, context);
  const bool was_known = has_published_velocity(track, config);
  if (!accepts(track, observation, share.label, time_s, context)) return UpdateOutcome::kRejected;
  const bool is_known_again =
      track.existence.confirmed && !was_known && has_published_velocity(track, config);
  if (is_known_again) track.existence.velocity_check.known_since_ns = context.scan().stamp_ns;
  update_existence(track, share, time_s, context);
  prepare_confirmation(track, observation, time_s, context);
  return passes_velocity_check(track, observation, is_known_again, context)
             ? UpdateOutcome::kConfirmable
             : UpdateOutcome::kContinues;
}

}  // namespace slammot::tracking
