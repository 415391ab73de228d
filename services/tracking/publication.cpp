#include "services/tracking/publication.hpp"

#include <algorithm>
#include <array>

#include "services/tracking/published_covariance.hpp"

namespace slammot::tracking {
namespace {

using Eigen::Matrix2d;
using Eigen::Vector2d;

constexpr double kPublishScore = 0.0;   ///< As likely as not.
constexpr double kUnseenAfterS = 0.02;  ///< Since the last echo: less than a scan.

/// True for a vehicle whose velocity was unknown a moment ago and that is elsewhere than predicted:
/// it may be another one.
bool may_be_another(const Track& track) {
  constexpr double kMostNis = 4.0;  // twice the mean of a consistent filter
  constexpr std::int64_t kLongestNs = 1'000'000'000;
  const std::int64_t known_since_ns = track.existence.velocity_check.known_since_ns;
  const bool is_known_again =
      known_since_ns != 0 && track.history.last_seen_ns - known_since_ns < kLongestNs;
  return is_vehicle(track) && is_known_again && track.existence.consistency.nis > kMostNis;
}

/// True if the object has not travelled and seems to stand already: it may never have moved. Where
/// only people move it is the standing foot of a pedestrian.
bool may_always_have_stood(const Track& track, const TrackingConfig& config) {
  const bool seems_to_stand = track.kinematics.move_stop.stands ||
                              track.velocity_mps().norm() < config.motion.stopped_below_mps;
  return !only_people_move(config) && track.existence.travel.travelled_m == 0.0 && seems_to_stand;
}

double unseen_s(const Track& track, std::int64_t stamp_ns) {
  constexpr double kLongestBetweenScansS = 0.25;  // between two scans of its scanner an object is
                                                  // not unseen
  const double since_in_view_s = std::min(track.history.since_in_view_s, kLongestBetweenScansS);
  return static_cast<double>(stamp_ns - track.history.last_seen_ns) * 1e-9 - since_in_view_s;
}

/// Prediction of the mixture for three seconds. An object held to stand may start in any mode.
void predict_path(const Track& track, const Matrix2d& common_error_m2, const TrackingConfig& config,
                  std::vector<flow::PredictedPosition>& path) {
  constexpr std::size_t kSteps = 6;
  constexpr double kStepS = 0.5;
  const Kinematics& kinematics = track.kinematics;
  filters::ImmState now = kinematics.mixture;
  if (kinematics.move_stop.stands)
    now.modes.fill(filters::estimate_of(kinematics.move_stop, kinematics.estimate));
  std::array<filters::Gaussian<2>, kSteps> predicted;
  filters::imm_foretell(models_of(kinematics, config), now, kStepS, predicted);
  for (const filters::Gaussian<2>& there : predicted) {
    const double after_s = kStepS * static_cast<double>(path.size() + 1);
    path.push_back({after_s, there.mean, there.covariance + common_error_m2});
  }
}

void publish_motion(const Track& track, const TrackingConfig& config, flow::TrackedObject& object) {
  const Kinematics& kinematics = track.kinematics;
  const filters::MotionState estimate =
      filters::estimate_of(kinematics.move_stop, kinematics.estimate);
  object.velocity_in_odom_mps = estimate.mean.segment<2>(2);
  object.position_in_odom_m =
      track.position_m() - kinematics.time_offset_s * object.velocity_in_odom_mps;
  const Eigen::DiagonalMatrix<double, 4> factors = noise_factors(track, config);
  object.covariance = factors *
                      covariance_after(kinematics.estimate.covariance.topLeftCorner<4, 4>(),
                                       -kinematics.time_offset_s) *
                      factors;
  object.acceleration_in_odom_mps2 = estimate.mean.segment<2>(4);
  object.motion = kinematics.move_stop.stands ? flow::Motion::kStopped : kinematics.state;
  object.mode_probability = kinematics.mixture.probability;
}

void publish_extent(const Track& track, flow::TrackedObject& object) {
  const Footprint& footprint = track.footprint();
  object.heading_in_odom_rad = track.extent.box() != nullptr
                                   ? footprint.heading_rad
                                   : course_of(track.kinematics).heading_rad;
  object.length_m = footprint.length.value_m;
  object.width_m = footprint.width.value_m;
  object.contour_in_odom_m = track.extent.contour_in_odom_m;
}

}  // namespace

bool is_published(const Track& track, std::int64_t stamp_ns, const TrackingConfig& config) {
  const Existence& existence = track.existence;
  return existence.confirmed && !existence.velocity_check.is_refuted &&
         !may_always_have_stood(track, config) && existence.score >= kPublishScore &&
         has_published_velocity(track, config) && !may_be_another(track) &&
         unseen_s(track, stamp_ns) <= kUnseenAfterS;
}

bool is_published_as_occluded(const Track& track, std::int64_t stamp_ns,
                              const TrackingConfig& config) {
  constexpr double kLeastPublishedS = 0.1;
  constexpr double kMostSigmaM = 3.0;
  const Existence& existence = track.existence;
  const History& history = track.history;
  if (!history.first_published_ns || !existence.confirmed || existence.velocity_check.is_refuted)
    return false;
  const double published_s =
      static_cast<double>(history.last_seen_ns - *history.first_published_ns) * 1e-9;
  return published_s >= kLeastPublishedS &&
         unseen_s(track, stamp_ns) <= config.publication.longest_unseen_published_s &&
         existence.score >= kPublishScore &&
         track.kinematics.position_covariance_m2().trace() < 2.0 * kMostSigmaM * kMostSigmaM;
}

void publish(const Track& track, std::int64_t stamp_ns, const TrackingConfig& config,
             flow::TrackedObject& object) {
  object.track_id = track.object_id;
  const bool is_seen = is_published(track, stamp_ns, config);
  object.occluded = !is_seen && is_published_as_occluded(track, stamp_ns, config);
  object.confirmed = is_seen || object.occluded;
  object.existence = existence_of(track.existence.score);
  object.object_class = track.classification.likeliest;
  object.class_probability = track.classification.probability;
  object.first_seen_ns = track.history.first_seen_ns;
  object.last_seen_ns = track.history.last_seen_ns;
  publish_motion(track, config, object);
  publish_extent(track, object);
  const Matrix2d common_error_m2 =
      common_error_covariance(track, object.heading_in_odom_rad, config);
  object.covariance.topLeftCorner<2, 2>() += common_error_m2;
  object.predicted_path.clear();
  if (track.existence.confirmed)
    predict_path(track, common_error_m2, config, object.predicted_path);
  // Everything is published at the stamp, and estimated when its beam is fired.
  const Vector2d since_stamp_m = track.kinematics.time_offset_s * object.velocity_in_odom_mps;
  for (Eigen::Vector2f& point_m : object.contour_in_odom_m) point_m -= since_stamp_m.cast<float>();
  for (flow::PredictedPosition& there : object.predicted_path)
    there.position_in_odom_m -= since_stamp_m;
}

flow::TrackedObject published(const Track& track, std::int64_t stamp_ns,
                              const TrackingConfig& config) {
  flow::TrackedObject object;
  publish(track, stamp_ns, config, object);
  return object;
}

}  // namespace slammot::tracking
