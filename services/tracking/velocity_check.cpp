#include "services/tracking/velocity_check.hpp"

#include <algorithm>
#include <cmath>

#include "services/tracking/confirmation.hpp"
#include "services/tracking/speed_evidence.hpp"

namespace slammot::tracking {
namespace {

using Eigen::Vector2d;

/// Direction in which the object moves: the length of a box, or the course.
Vector2d direction_of(const Track& track) {
  const double heading_rad = track.footprint().heading_rad;
  return track.extent.box() != nullptr ? Vector2d(std::cos(heading_rad), std::sin(heading_rad))
                                       : Vector2d(track.velocity_mps().normalized());
}

double seconds_since(std::int64_t since_ns, const ScanContext& context) {
  return static_cast<double>(context.scan().stamp_ns - since_ns) * 1e-9;
}

}  // namespace

void check_velocity(Track& track, const Observation& observation, const ScanContext& context) {
  constexpr double kFastestOfSigmas = 1.25;  // of the largest likely speed: no larger one is
                                             // searched
  constexpr double kYoungS = 2.0;
  constexpr double kLongEnoughS = 0.35;  // for what earlier scans did not see well
  constexpr double kSlowMps = 4.0;
  constexpr double kSlackMps = 1.0;
  constexpr double kTellingSigmaMps = 2.0;
  constexpr double kVagueSigmaMps = 4.0;
  VelocityCheck& check = track.existence.velocity_check;
  check.is_refuted = false;
  const double age_s = seconds_since(track.history.first_seen_ns, context);
  const double known_s =
      seconds_since(std::max(track.history.first_seen_ns, check.known_since_ns), context);
  const Vector2d velocity_mps = track.velocity_mps();
  const bool is_fast = velocity_mps.norm() > kSlowMps;
  if (known_s > kYoungS || (track.extent.box() == nullptr && !is_fast)) return;
  const Vector2d along = direction_of(track);
  const double speed_mps = velocity_mps.dot(along);
  const double across_mps = (velocity_mps - speed_mps * along).norm();
  const SpeedEvidence evidence =
      speed_along({along, observation.points_m, context.scan().stamp_ns, track.track_id},
                  context.history, kFastestOfSigmas * context.config.motion.fastest_mps);
  const bool moves_sideways = across_mps > 2.0 + 0.3 * std::abs(speed_mps);
  const bool is_off = moves_sideways || std::abs(speed_mps - evidence.speed_mps) >
                                            3.0 * evidence.sigma_mps + kSlackMps;
  const bool is_vague = is_fast && age_s < kLongEnoughS && evidence.sigma_mps > kVagueSigmaMps &&
                        !appeared_in_free_space(track, context.config);
  if (is_off && evidence.sigma_mps < kTellingSigmaMps)
    restart_velocity(track.kinematics, evidence.speed_mps * along, evidence.sigma_mps,
                     context.config);
  else check.is_refuted = is_off || is_vague;
}

}  // namespace slammot::tracking
