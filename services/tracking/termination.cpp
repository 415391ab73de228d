#include "services/tracking/termination.hpp"

#include <algorithm>

#include "services/tracking/confirmation.hpp"
#include "services/tracking/evidence_limits.hpp"

namespace slammot::tracking {

bool is_timed_out(const Track& track, double age_s, const TrackingConfig& config) {
  constexpr double kTimesIfMoving = 2.0;
  if (track.existence.confirmed || age_s <= evidence_limits(config).longest_tentative_s)
    return false;
  const bool seems_to_move = track.existence.score >= kConfirmScore && is_surely_fast(track) &&
                             has_travelled(track, config);
  return !seems_to_move || age_s > kTimesIfMoving * evidence_limits(config).longest_tentative_s;
}

bool claims_motion_without_travel(const Track& track, const TrackingConfig& config) {
  constexpr double kMostTimesProgress = 4.0;
  return track.existence.travel.claimed_m >
         kMostTimesProgress * kProgressM * config.extent.size_scale;
}

bool has_stood_too_long(const Track& track, std::int64_t stamp_ns, const TrackingConfig& config) {
  const Travel& travel = track.existence.travel;
  const double least_share = only_people_move(config) ? 1.0 : 0.25;
  const double may_stand_s =
      kLongestStandS *
      std::max(least_share, travel.travelled_m / config.existence.least_travel_to_stand_m);
  const bool is_vehicle_that_came = !only_people_move(config) && track.extent.box() != nullptr &&
                                    travel.travelled_m >= config.existence.least_travel_to_stand_m;
  const std::int64_t idle_since_ns =
      is_vehicle_that_came ? std::max(travel.last_moving_ns, track.history.last_seen_ns)
                           : travel.last_moving_ns;
  return static_cast<double>(stamp_ns - idle_since_ns) * 1e-9 > may_stand_s;
}

bool has_ended(const Track& track, std::int64_t stamp_ns, const TrackingConfig& config) {
  const double unseen_s = static_cast<double>(stamp_ns - track.history.last_seen_ns) * 1e-9;
  const double age_s = static_cast<double>(stamp_ns - track.history.first_seen_ns) * 1e-9;
  const bool is_lost =
      unseen_s > (track.existence.confirmed ? config.existence.longest_unseen_s
                                            : evidence_limits(config).longest_unseen_tentative_s);
  const bool never_moved = track.existence.confirmed && has_stood_too_long(track, stamp_ns, config);
  return is_lost || is_timed_out(track, age_s, config) || never_moved ||
         claims_motion_without_travel(track, config) || track.existence.score < kRejectScore;
}

}  // namespace slammot::tracking
