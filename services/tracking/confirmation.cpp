#include "services/tracking/confirmation.hpp"

#include <algorithm>
#include <cmath>

#include "services/tracking/evidence_limits.hpp"

namespace slammot::tracking {
namespace {

using Eigen::Vector2d;

constexpr double kLeastMovedShare = 0.3;  ///< Of all votes.
constexpr double kSureMovedShare = 0.7;
constexpr double kLeastTravelSigmas = 3.0;  ///< Of the distance from birth.

bool echoes_lie_off_sides(const Track& track, const TrackingConfig& config) {
  constexpr double kMostM = 0.2;
  return track.extent.box() != nullptr &&
         track.existence.consistency.off_sides_m > kMostM * config.extent.size_scale;
}

/// Place of the first observation. The extent at that time may have been wrong: the oldest stored
/// observation is measured by the present extent, if that is more certain.
MeasuredCentre birth_of(const Track& track, const TrackingConfig& config) {
  const MeasuredCentre& then = track.history.birth;
  const Box* box = track.extent.box();
  if (box == nullptr || track.history.observations.size() == 0) return then;
  const Observation observation = track.history.observations[0].with_points();
  const BoxMeasurement measured =
      measure_box(*box, supposed_centre_m(*box, observation), observation, config);
  return measured.covariance_m2.trace() < then.R.trace()
             ? MeasuredCentre{measured.centre_m - measured.recentring_m, measured.covariance_m2}
             : then;
}

/// True if the velocity is known well enough for confirmation. For an object that appeared in free
/// space and moves as predicted, the precision required for publication suffices.
bool has_known_velocity(const Track& track, const TrackingConfig& config) {
  constexpr double kMostNis = 2.0;  // the mean of a consistent filter
  const Consistency& consistency = track.existence.consistency;
  const bool is_as_predicted = consistency.weight > 0.0 && consistency.nis < kMostNis &&
                               appeared_in_free_space(track, config);
  const double most_mps =
      is_as_predicted
          ? std::max(kKnownSpeedSigmaMps, config.publication.most_speed_sigma_published_mps)
          : kKnownSpeedSigmaMps;
  return speed_sigma_mps(track.kinematics) <= most_mps;
}

bool has_moved(const Track& track, const TrackingConfig& config) {
  // An object that emerges from behind others is where no earlier scan could see: most echoes are
  // undecided. Where the map says that it has come, one vote tells that the map is right: walls in
  // space wrongly mapped as free have none.
  constexpr double kLeastVotes = 0.5;  // one, half faded
  const MotionEvidence& evidence = track.existence.motion;
  return (evidence.moved >= kLeastMovedVotes &&
          evidence.moved >= kLeastMovedShare * evidence.weight()) ||
         (evidence.moved > kLeastVotes && appeared_in_free_space(track, config));
}

/// True if most echoes come from where beams passed before, which no stationary object does.
bool has_arrived(const Track& track) {
  const MotionEvidence& evidence = track.existence.motion;
  return evidence.moved >= kSureMovedVotes && evidence.moved >= kSureMovedShare * evidence.weight();
}

/// All conditions of confirmation but the fit of the extent.
bool moves_by_all_signs(const Track& track, const TrackingConfig& config) {
  const Existence& existence = track.existence;
  return existence.hits >= evidence_limits(config).least_hits && existence.score >= kConfirmScore &&
         has_moved(track, config) && has_known_velocity(track, config) && is_surely_fast(track) &&
         (has_arrived(track) || has_travelled(track, config));
}

}  // namespace

bool is_confirmable(const Track& track, const TrackingConfig& config) {
  return !echoes_lie_off_sides(track, config) && moves_by_all_signs(track, config);
}

bool misfits_only(const Track& track, const TrackingConfig& config) {
  return echoes_lie_off_sides(track, config) && moves_by_all_signs(track, config);
}

bool appeared_in_free_space(const Track& track, const TrackingConfig& config) {
  constexpr double kFewestEchoes = 3.0;           // each of fewer may be a mixed pixel
  constexpr double kLeastShareInFreeSpace = 0.7;  // the map is not sure of all free space
  constexpr double kMostStoodShare = 0.2;  // a flank slides along itself, and other objects are
                                           // near
  const TentativeEvidence& tentative = track.existence.tentative;
  const MotionEvidence& now = track.existence.motion;
  return !only_people_move(config) && track.existence.mean_echoes >= kFewestEchoes &&
         tentative.in_free_space >= kLeastShareInFreeSpace * tentative.seen &&
         tentative.stood <= kMostStoodShare * tentative.seen &&
         now.stood <= kMostStoodShare * now.weight();
}

bool is_inconsistent(const Track& track, const TrackingConfig& config) {
  constexpr double kMostNis = 2.5;
  return echoes_lie_off_sides(track, config) && track.existence.consistency.nis > kMostNis;
}

const Track* inconsistent_one(const Track& a, const Track& b, const TrackingConfig& config) {
  if (a.extent.box() == nullptr || b.extent.box() == nullptr ||
      is_inconsistent(a, config) == is_inconsistent(b, config))
    return nullptr;
  return is_inconsistent(a, config) ? &a : &b;
}

bool is_surely_fast(const Track& track) {
  constexpr double kPedestrianShare = 0.75;  // their covariance includes the gait, which a post
                                             // does not have
  const double sigmas = kDetectionSigmas * (may_be_pedestrian(track) ? kPedestrianShare : 1.0);
  return track.velocity_mps().norm() >=
         filters::minimum_detection_speed_mps(track.kinematics.estimate, sigmas);
}

bool has_travelled(const Track& track, const TrackingConfig& config) {
  const MeasuredCentre birth = birth_of(track, config);
  const Vector2d travel_m = track.position_m() - birth.centre_m;
  const double distance_m = travel_m.norm();
  const Vector2d way = travel_m / std::max(distance_m, 1e-6);
  const double sigma_m =
      std::sqrt(way.dot((track.kinematics.position_covariance_m2() + birth.R) * way));
  // A jump does not count: glass or chair legs that answer in turns would travel far at once.
  const double covered_m =
      distance_m - (may_be_pedestrian(track) ? track.kinematics.innovation_m : 0.0);
  return covered_m >= config.existence.least_travel_m && covered_m >= kLeastTravelSigmas * sigma_m;
}

}  // namespace slammot::tracking
