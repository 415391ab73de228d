#include "services/tracking/measurement_update.hpp"

#include <algorithm>
#include <cmath>

#include "common/association/gating.hpp"
#include "services/tracking/extent_update.hpp"
#include "services/tracking/heading_update.hpp"

namespace slammot::tracking {
namespace {

using Eigen::Matrix2d;
using Eigen::Vector2d;

constexpr double kStandingMemoryS = 0.5;  ///< Of the stop hypothesis (Wang 2004, Section 4.6):
                                          ///< docs/decisions/motion-models.md.
constexpr double kOutlierSigmas = 6.0;    ///< docs/decisions/association.md.

/// Factor of the noise of a known pedestrian's centre at this squared distance. They are given
/// echoes of others now and then: errors have the tails of Student's t, whose weight for a centre
/// is the inverse of this factor (Lange 1989).
double outlier_factor(double distance2) {
  constexpr double kDegreesOfFreedom = 4.0;
  return std::max(1.0, (kDegreesOfFreedom + distance2) / (kDegreesOfFreedom + 2.0));
}

/// An observation as a measurement of the position.
struct PositionUpdate {
  OutlineMeasurement measurement;
  Matrix2d noise_at_rest_m2 = Matrix2d::Identity();  ///< Without the gait.
  Matrix2d R = Matrix2d::Identity();
  Vector2d innovation_m = Vector2d::Zero();
  double distance2 = 0.0;  ///< Squared Mahalanobis distance of the innovation.
};

PositionUpdate position_update(const Track& track, const Observation& observation,
                               const Matrix2d& pose_covariance_m2, double time_s,
                               const TrackingConfig& config) {
  PositionUpdate update;
  update.measurement = measure(track.extent.outline, track.position_m(), observation, config);
  update.R = update.measurement.covariance_m2 + pose_covariance_m2;
  update.noise_at_rest_m2 = update.R;
  if (may_be_pedestrian(track)) update.R += gait_variance_m2(time_s, config) * Matrix2d::Identity();
  update.innovation_m =
      update.measurement.centre_m - update.measurement.recentring_m - track.position_m();
  update.distance2 = association::mahalanobis_squared<2>(
      update.innovation_m,
      track.kinematics.position_covariance_m2() + update.measurement.step_covariance_m2 + update.R);
  return update;
}

bool is_outlier(const Track& track, const PositionUpdate& update, const TrackingConfig& config) {
  return track.existence.confirmed && update.distance2 > kOutlierSigmas * kOutlierSigmas &&
         update.innovation_m.norm() > config.existence.least_surprise_m;
}

void update_gait(Track& track, const PositionUpdate& update, double time_s,
                 const TrackingConfig& config) {
  if (!may_be_pedestrian(track)) return;
  const GaitNoise before{
      std::pow(gait_share(track.kinematics.gait, *track.footprint().road_users, config) *
                   gait_sigma_m(config),
               2)};
  track.kinematics.gait =
      with_step(before, update.innovation_m, update.noise_at_rest_m2, time_s, config);
}

void update_position(Track& track, const PositionUpdate& update, double time_s,
                     const TrackingConfig& config) {
  Kinematics& kinematics = track.kinematics;
  const filters::ModelSet models = models_of(kinematics, config);
  shift(track, update.measurement.recentring_m, config);
  filters::imm_loosen(models, kinematics.mixture, update.measurement.step_covariance_m2);
  track.extent.outline = update.measurement.outline;
  const Matrix2d R =
      kinematics.cruises_only ? Matrix2d(outlier_factor(update.distance2) * update.R) : update.R;
  kinematics.mixture =
      filters::imm_update(models, kinematics.mixture, update.measurement.centre_m, R).posterior;
  kinematics.measured = {update.measurement.centre_m, R};
  kinematics.estimate = filters::imm_combine(models, kinematics.mixture);
  filters::MotionState moving = kinematics.estimate;
  // Standing legs have no gait.
  moving.covariance *= update.noise_at_rest_m2.trace() / update.R.trace();
  if (!config.motion.move_stop) return;
  kinematics.move_stop =
      filters::weigh(kinematics.move_stop, {moving, update.measurement.centre_m, time_s},
                     {kStandingMemoryS, kDetectionSigmas});
}

void update_consistency(Track& track, double nis, double time_s, const Observation& observation,
                        const TrackingConfig& config) {
  Extent& extent = track.extent;
  const double off_sides_m =
      distance_from_sides_m(extent.footprint(), track.position_m(), observation.points_m);
  extent.range_m = (track.position_m() - observation.laser_m).norm();
  track.existence.consistency = with_scan(track.existence.consistency, off_sides_m, nis, time_s);
  if (track.existence.confirmed && extent.box() != nullptr)
    extent.outline_error = with_outline(extent.outline_error, off_sides_m,
                                        observation.points_m.size(), extent.range_m, config);
}

void update_travel(Track& track, const TrackingConfig& config) {
  Travel& travel = track.existence.travel;
  const double step_m = (track.position_m() - travel.anchor_m).norm();
  if (step_m <= kProgressM * config.extent.size_scale) return;
  // A larger jump is a change of the object.
  travel.travelled_m += std::min(step_m, 2.0 * kProgressM * config.extent.size_scale);
  travel.anchor_m = track.position_m();
  travel.claimed_m = 0.0;
  travel.without_progress_s = 0.0;
}

void update_motion_state(Track& track, std::int64_t stamp_ns, const TrackingConfig& config) {
  update_travel(track, config);
  const double speed = track.velocity_mps().norm();
  if (speed < config.motion.stopped_below_mps) track.kinematics.state = flow::Motion::kStopped;
  if (speed > moving_above_mps(config)) track.kinematics.state = flow::Motion::kMoving;
  if (speed > moving_above_mps(config) || track.kinematics.state == flow::Motion::kMoving)
    track.existence.travel.last_moving_ns = stamp_ns;
}

}  // namespace

void note_observation(Track& track, std::int64_t stamp_ns, const Observation& observation) {
  ++track.existence.hits;
  track.history.last_seen_ns = stamp_ns;
  store_contour(track.extent, observation);
}

bool update(Track& track, std::int64_t stamp_ns, const Observation& observation,
            const Matrix2d& pose_covariance_m2, const TrackingConfig& config) {
  constexpr double kLeastStepS = 1e-3;  // two scanners may have the same stamp
  const double unseen_s =
      std::max(kLeastStepS, static_cast<double>(stamp_ns - track.history.last_seen_ns) * 1e-9);
  if (track.extent.box() != nullptr) exchange_sides_if_likelier(track, observation, config);
  if (track.extent.box() != nullptr)
    follow_side(track, observation, unseen_s, config);  // first: sizes are measured along the sides
  const PositionUpdate of_position =
      position_update(track, observation, pose_covariance_m2, unseen_s, config);
  if (is_outlier(track, of_position, config)) return false;
  track.kinematics.innovation_m = of_position.innovation_m.norm();
  update_gait(track, of_position, unseen_s, config);
  update_position(track, of_position, unseen_s, config);
  note_observation(track, stamp_ns, observation);
  // A hidden object moves unseen: its claim is judged when it is seen again.
  track.existence.travel.claimed_m +=
      std::max(0.0, track.velocity_mps().norm() - moving_above_mps(config)) * unseen_s;
  if (track.extent.box() != nullptr) {
    follow_axis(track, unseen_s, config);
    follow_course(track, observation, unseen_s, config);
  } else {
    become_box_if_large(track, observation, config);
  }
  update_consistency(track, of_position.distance2, unseen_s, observation, config);
  update_motion_state(track, stamp_ns, config);
  update_class(track, unseen_s, config);
  return true;
}

}  // namespace slammot::tracking
