#include "services/tracking/road_user_learning.hpp"

#include <algorithm>
#include <cmath>

namespace slammot::tracking {
namespace {

constexpr double kLeastTravelM = 5.0;  ///< After this distance, before scaling, a track is not a
                                       ///< part of something stationary.

Size unscaled(const Size& size, double scale) {
  return {size.value_m / scale, size.variance_m2 / (scale * scale)};
}

/// A size seen from edge to edge lacks the parts without echoes; the largest part ever seen
/// includes the largest error: the truth lies between.
Size between(const Size& whole, double least_m) {
  const double off_m = 0.5 * std::max(0.0, least_m - whole.value_m);
  return {whole.value_m + off_m, whole.variance_m2 + off_m * off_m};
}

}  // namespace

void learn_sizes(RoadUsersSeen& seen, const Track& track, const TrackingConfig& config) {
  constexpr double kKnownM = 0.15;  // one sigma
  const Box* box = track.extent.box();
  const double scale = config.extent.size_scale;
  if (!track.existence.confirmed || box == nullptr || !box->is_oriented ||
      track.existence.travel.travelled_m < kLeastTravelM * scale)
    return;
  const double known_m2 = std::pow(kKnownM * scale, 2);
  const SizesSeen evidence = evidence_by_kind(*box, config).of(box->kind);
  const Size length = evidence.length.whole;
  const Size width = evidence.width.whole;
  if (length.variance_m2 > known_m2 || box->length.variance_m2 > known_m2)
    return;  // the length tells the kind
  seen.add_length(box->kind, unscaled(between(length, box->evidence.length.least_m), scale));
  if (width.variance_m2 <= known_m2 && box->width.variance_m2 <= known_m2)
    seen.add_width(box->kind, unscaled(between(width, box->evidence.width.least_m), scale));
  if (box->kind != Kind::kBicycle && box->corner_seen.variance_m2 <= known_m2)
    seen.add_corner(unscaled(box->corner_seen, scale));
}

void learn_outline_error(RoadUsersSeen& seen, const Track& track, const TrackingConfig& config) {
  constexpr int kFewestScans = 20;
  const Box* box = track.extent.box();
  const bool is_known_vehicle = track.existence.confirmed && is_vehicle(track) && box->is_oriented;
  const OutlineError& error = track.extent.outline_error;
  if (!is_known_vehicle || only_people_move(config) ||
      track.existence.travel.travelled_m < kLeastTravelM * config.extent.size_scale ||
      error.scans < kFewestScans)
    return;
  seen.add_off_sides_share(error.shares / error.echoes);
}

void learn_gait(RoadUsersSeen& seen, const Track& track, const TrackingConfig& config) {
  constexpr double kSeenForS = 3.0;  // twice the memory of the gait noise
  const double seen_for_s =
      static_cast<double>(track.history.last_seen_ns - track.history.first_seen_ns) * 1e-9;
  const GaitNoise& gait = track.kinematics.gait;
  if (!track.existence.confirmed || !may_be_pedestrian(track) || only_people_move(config) ||
      !gait.variance_m2 || seen_for_s < kSeenForS)
    return;
  seen.add_swing_share(gait_share(gait, *track.footprint().road_users, config));
}

void learn_from(RoadUsersSeen& seen, const Track& track, const TrackingConfig& config) {
  learn_sizes(seen, track, config);
  learn_outline_error(seen, track, config);
  learn_gait(seen, track, config);
}

void LocalRoadUsers::learn(const Track& track, const TrackingConfig& config) {
  learn_from(seen_, track, config);
  is_outdated_ = true;
}

void LocalRoadUsers::refresh() {
  if (is_outdated_) *known_ = seen_.known();
  is_outdated_ = false;
}

}  // namespace slammot::tracking
