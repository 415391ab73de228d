#include "services/tracking/track.hpp"

#include <algorithm>
#include <cmath>

namespace slammot::tracking {
namespace {

using Eigen::Matrix2d;
using Eigen::Vector2d;

/// Random walk of the heading: at one speed, smaller objects turn faster.
double heading_drift_rad2_per_s(const TrackingConfig& config) {
  return 0.1 / config.extent.size_scale;
}

/// The coordinated turn is linearised about the velocity, which must be well known; pedestrians and
/// tentative tracks have no wheels that tie the course to the speed.
bool is_surely_driving(const Track& track, const TrackingConfig& config) {
  constexpr double kSlowestMps = 2.0;
  constexpr double kSigmas = 4.0;
  const double variance = 0.5 * track.kinematics.velocity_covariance().trace();
  return track.existence.confirmed && track.extent.box() != nullptr &&
         track.velocity_mps().squaredNorm() >
             std::max(std::pow(kSlowestMps * config.extent.size_scale, 2),
                      kSigmas * kSigmas * variance);
}

/// The speed counts for the class once the track is confirmed, while it is known and not zero.
bool has_known_speed(const Track& track) {
  const bool is_known = track.existence.confirmed && !track.existence.velocity_check.is_refuted &&
                        speed_sigma_mps(track.kinematics) < kKnownSpeedSigmaMps;
  return is_known && !track.kinematics.move_stop.stands &&
         track.kinematics.state == flow::Motion::kMoving;
}

/// White acceleration of an unseen object [m^2/s^3]: vehicles accelerate along their axis.
Matrix2d unseen_acceleration_density(const Track& track) {
  constexpr double kPedestrian = 0.2;
  constexpr double kAlong = 2.0;
  constexpr double kAcross = 0.05;
  if (!is_vehicle(track)) return kPedestrian * Matrix2d::Identity();
  const double heading_rad = track.footprint().heading_rad;
  const Vector2d along(std::cos(heading_rad), std::sin(heading_rad));
  const Vector2d across(-along.y(), along.x());
  return kAlong * along * along.transpose() + kAcross * across * across.transpose();
}

}  // namespace

bool is_vehicle(const Track& track) { return is_vehicle(track.extent.outline); }

bool is_known_pedestrian(const Track& track) {
  constexpr int kLongKnownHits = 20;
  constexpr double kSure = 0.9;
  return track.existence.confirmed && track.extent.box() == nullptr &&
         track.existence.hits >= kLongKnownHits &&
         track.classification.probability_of(flow::ObjectClass::kPedestrian) > kSure;
}

bool may_be_pedestrian(const Track& track) {
  return is_known_pedestrian(track) ||
         (track.extent.box() == nullptr && track.extent.largest_span_m < 1.0 &&
          track.velocity_mps().norm() < kFastestWalkMps);
}

void shift(Track& track, const Vector2d& by_m, const TrackingConfig& config) {
  shift(track.kinematics, by_m, config);
  track.history.birth.centre_m += by_m;
  track.existence.travel.anchor_m += by_m;
}

void predict(Track& track, double time_s, const TrackingConfig& config) {
  Kinematics& kinematics = track.kinematics;
  kinematics.measured.reset();
  kinematics.recentred_m.setZero();
  kinematics.cruises_only = is_known_pedestrian(track) || track.history.is_unseen;
  kinematics.may_turn = config.motion.coordinated_turn && is_surely_driving(track, config);
  predict(kinematics, time_s, config);
  if (track.history.is_unseen) {
    filters::imm_add_acceleration_noise(models_of(kinematics, config), kinematics.mixture,
                                        unseen_acceleration_density(track), time_s);
    combine(kinematics, config);
  }
  if (Box* box = track.extent.box()) {
    box->heading_variance_rad2 =
        std::min(10.0, box->heading_variance_rad2 + heading_drift_rad2_per_s(config) * time_s);
    box->axis_variance_rad2 =
        std::min(10.0, box->axis_variance_rad2 + heading_drift_rad2_per_s(config) * time_s);
  }
}

bool has_published_velocity(const Track& track, const TrackingConfig& config) {
  return speed_sigma_mps(track.kinematics) <= config.publication.most_speed_sigma_published_mps;
}

void update_class(Track& track, double time_s, const TrackingConfig& config) {
  constexpr double kLongestHeldS = 0.2;
  Classification& classification = track.classification;
  if (has_known_speed(track))
    classification.speeds =
        with_speed(classification.speeds,
                   {track.velocity_mps().norm(), speed_sigma_mps(track.kinematics),
                    std::min(time_s, kLongestHeldS)},
                   config);
  classification.probability =
      class_probabilities(track.extent.outline, classification.speeds, config);
  classification.likeliest = likeliest_class(classification.probability);
}

void confirm(Track& track, std::int64_t stamp_ns, const TrackingConfig& config) {
  track.existence.confirmed = true;
  Travel& travel = track.existence.travel;
  travel.last_moving_ns = stamp_ns;  // though it may be slower than what counts as moving
  travel.travelled_m = 0.0;          // until now it may have been made of several objects
  travel.anchor_m = track.position_m();
  clear_tentative(track.history);
  if (has_known_speed(track))
    track.classification.speeds =
        with_first_speed({track.velocity_mps().norm(), speed_sigma_mps(track.kinematics)}, config);
  update_class(track, 0.0, config);
}

}  // namespace slammot::tracking
