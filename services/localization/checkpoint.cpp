#include "services/localization/checkpoint.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "services/localization/byte_stream.hpp"

namespace slammot::localization {
namespace {

constexpr std::uint64_t kMark = 0x736c616d6d6f7470;  // "slammotp": its last letter counts forms
constexpr double kFastestRestored = 1e3;  // m/s or rad/s: no vehicle was faster when the checkpoint
                                          // was made
constexpr double kLargestFactor = 1e4;    // of way or turn: millimetres taken for metres are 1e3
constexpr double kFarthestStamp_ns = 4e18;  // 126 years: differences of stamps do not overflow

template <typename Estimate, typename Visitor>
void visit_estimate(Estimate& estimate, Visitor visit) {
  visit(estimate.odom_from_base);
  visit(estimate.calibration);
  visit(estimate.velocity);
  visit(estimate.covariance);
}

template <typename LastScan, typename Visitor>
void visit_last(LastScan& last, Visitor visit) {
  visit(last.stamp_ns);
  visit(last.has_wheels);
  visit(last.wheel_from_base);
  visit(last.knows_velocity);
  visit(last.was_sampled);
  visit(last.speed_mps);
  visit(last.yaw_rate_radps);
  visit(last.doubted_wheels);
  visit(last.trusted_s);
  visit(last.stood_s);
  visit(last.wheels_have_counted);
}

template <typename Belief, typename Visitor>
void visit_belief(Belief& belief, Visitor visit) {
  visit(belief.weights);
  visit(belief.last);
  visit(belief.usual_step_s);
  visit(belief.last_step);
  visit(belief.steps);
  visit(belief.previous_by_wheels);
  visit(belief.previous_duration_s);
  visit(belief.last_by_wheels);
  visit(belief.last_duration_s);
  visit(belief.usual_way_m);
  visit(belief.usual_drive_m);
  visit(belief.usual_turn_rad);
  visit(belief.usual_share);
  visit(belief.matched_velocity);
  visit(belief.matched_velocity_variance);
  visit(belief.factors);
  belief.estimator.visit(visit);
  visit(belief.log_odds);
  visit(belief.log_odds_of_factors);
  visit(belief.disbeliefs);
  visit(belief.confirmed_ns);
  visit(belief.disbelieved_s);
  visit(belief.is_disbelieved);
  visit(belief.recalibrated_scans);
  visit(belief.recalibrations);
}

template <typename Monitor, typename Visitor>
void visit_monitor(Monitor& monitor, Visitor visit) {
  visit(monitor.lost_since_ns);
  visit(monitor.unmatched_scans);
  visit(monitor.lost_scans);
  visit(monitor.scans_to_prove);
  visit(monitor.contradicts_map);
  visit(monitor.explained_before);
  visit(monitor.everything_changed);
}

template <typename State, typename Visitor>
void visit_submaps(State& submaps, Visitor visit) {
  visit(submaps.map_from_odom);
  visit(submaps.correction_sequence);
  visit(submaps.previous_from_submap.pose);
  visit(submaps.previous_from_submap.covariance);
  visit(submaps.travel.drift);
  visit(submaps.travel.travelled_m);
  visit(submaps.is_ended);
  visit(submaps.short_submaps_left);
}

template <typename State, typename Visitor>
void visit_pose(State& pose, Visitor visit) {
  visit_last(*pose.prediction.last, visit);
  visit_estimate(pose.prediction.estimate, visit);
  visit_estimate(pose.prediction.with_stamp_offset, visit);
  visit(pose.prediction.applies_stamp_offset);
  visit_estimate(pose.prediction.with_pivot, visit);
  visit(pose.prediction.applies_pivot);
  visit(pose.prediction.innovations);
  pose.prediction.turn_noise.visit(visit);
  pose.prediction.slip.visit(visit);
  pose.prediction.speed_change.visit(visit);
  visit_belief(pose.prediction.belief, visit);
  visit_monitor(pose.monitor, visit);
  visit(pose.covariance.factors.of_axis);
  visit(pose.covariance.factors.dead_reckoned);
  visit(pose.covariance.map_change.way_m);
  visit(pose.covariance.map_change.squared_residuals);
  visit(pose.covariance.by_scans_alone);
  visit(pose.sweep_factor.value);
  visit(pose.sweep_factor.variance);
}

/// The one list of what a checkpoint holds before odometry and map, in its order.
/// pose.prediction.last is there.
template <typename AnyCheckpoint, typename Visitor>
void visit_parts(AnyCheckpoint& checkpoint, Visitor visit) {
  visit_pose(checkpoint.pose, visit);
  visit_submaps(checkpoint.submaps, visit);
  visit(checkpoint.counters);
}

bool is_not_negative(double value) { return value >= 0.0 && std::isfinite(value); }

// Whether they may have been ours.

bool is_sound(const sensing::MotionEstimate& estimate) {
  return is_believable(estimate.odom_from_base) && is_believable(estimate.covariance) &&
         estimate.calibration.norm() < 1.0 && estimate.velocity.norm() < kFastestRestored;
}

bool is_sound(const OdometryPrediction::LastScan& last) {
  return last.trusted_s >= 0.0 && last.stood_s >= 0.0 &&
         std::hypot(last.speed_mps, last.yaw_rate_radps) < kFastestRestored &&
         std::abs(static_cast<double>(last.stamp_ns)) < kFarthestStamp_ns;
}

bool is_sound(const sensing::WheelFactors& factors) {
  return std::abs(factors.way) < kLargestFactor && std::abs(factors.turn) < kLargestFactor &&
         std::abs(factors.turn_bias_radps) < kFastestRestored;
}

bool is_count(int value) { return value >= 0 && value < std::numeric_limits<int>::max() / 2; }
bool is_share(double value) { return value >= 0.0 && value <= 1.0; }

bool is_sound(const std::optional<KeyframeOdometry::Keyframe>& keyframe) {
  if (!keyframe) return true;
  return is_believable(keyframe->wheel_from_base) && is_believable(keyframe->odom_from_base) &&
         std::abs(static_cast<double>(keyframe->stamp_ns)) < kFarthestStamp_ns &&
         std::ranges::all_of(keyframe->points_in_base_m, [](const geometry::Vector2& point_m) {
           return is_believable(point_m);
         });
}

bool is_sound(const KeyframeOdometry::State& keyframes) {
  return is_sound(keyframes.keyframe) &&
         std::abs(static_cast<double>(keyframes.compared_ns.value_or(0))) < kFarthestStamp_ns &&
         keyframes.way_ratio.is_sound();
}

bool is_sound(const sensing::OdometryBelief& belief) {
  const bool has_odds =
      std::isfinite(belief.log_odds) && std::isfinite(belief.log_odds_of_factors) &&
      is_not_negative(belief.disbelieved_s) && is_believable(belief.last_step) &&
      belief.steps.is_sound() && is_believable(belief.last_by_wheels) &&
      is_believable(belief.previous_by_wheels) && is_not_negative(belief.previous_duration_s) &&
      is_not_negative(belief.last_duration_s) && is_not_negative(belief.usual_way_m) &&
      is_not_negative(belief.usual_drive_m) && is_not_negative(belief.usual_turn_rad);
  if (!has_odds) return false;
  const bool has_weights =
      std::ranges::all_of(belief.weights, is_share) && std::ranges::max(belief.weights) > 0.0;
  return has_weights && sensing::index_of(belief.last) < sensing::kStepExplanations &&
         is_not_negative(belief.usual_step_s) && is_share(belief.usual_share) &&
         belief.matched_velocity.norm() < kFastestRestored &&
         belief.matched_velocity_variance.minCoeff() >= 0.0 &&
         belief.matched_velocity_variance.allFinite() && is_sound(belief.factors) &&
         is_sound(belief.estimator.factors()) &&
         is_believable(belief.estimator.turn_covariance()) &&
         is_not_negative(belief.estimator.way_sigma()) && is_count(belief.estimator.steps()) &&
         is_count(belief.recalibrated_scans);
}

bool is_sound(const LocalizationMonitor::State& monitor) {
  return std::abs(static_cast<double>(monitor.lost_since_ns.value_or(0))) < kFarthestStamp_ns &&
         is_count(monitor.unmatched_scans) && is_count(monitor.lost_scans) &&
         (monitor.lost_scans == 0 || monitor.lost_since_ns) && is_count(monitor.scans_to_prove) &&
         is_share(monitor.explained_before.value_or(0.0));
}

bool is_sound(const PublishedCovariance::State& covariance) {
  const sensing::VarianceFactors& factors = covariance.factors;
  return is_share(covariance.by_scans_alone) && factors.of_axis.minCoeff() >= 0.0 &&
         factors.of_axis.allFinite() && factors.dead_reckoned.minCoeff() >= 0.0 &&
         factors.dead_reckoned.maxCoeff() <= 1.0 && is_not_negative(covariance.map_change.way_m) &&
         is_not_negative(covariance.map_change.squared_residuals);
}

bool is_sound(const SubmapSequence::State& submaps) {
  return is_believable(submaps.map_from_odom) && is_believable(submaps.previous_from_submap.pose) &&
         is_believable(submaps.previous_from_submap.covariance) &&
         is_believable(submaps.travel.drift) && std::isfinite(submaps.travel.travelled_m);
}

bool is_sound(const PoseState& pose) {
  const OdometryPrediction::State& prediction = pose.prediction;
  return is_sound(prediction.estimate) && is_sound(prediction.with_stamp_offset) &&
         is_sound(prediction.with_pivot) && prediction.innovations.turns.is_sound() &&
         prediction.innovations.ways.is_sound() && prediction.turn_noise.is_sound() &&
         prediction.slip.is_sound() && prediction.speed_change.is_sound() &&
         is_sound(*prediction.last) && is_sound(prediction.belief) && is_sound(pose.monitor) &&
         is_sound(pose.covariance) && std::isfinite(pose.sweep_factor.value) &&
         pose.sweep_factor.variance >= 0.0;
}

bool is_sound(const Checkpoint& checkpoint) {
  return is_sound(checkpoint.pose) && is_sound(checkpoint.keyframes) &&
         is_sound(checkpoint.submaps) &&
         std::ranges::all_of(checkpoint.odometry, [](const sensing::Odometry& sample) {
           return is_believable(sample.wheel_from_base);
         });
}

void put_keyframe(std::vector<std::byte>& bytes,
                  const std::optional<KeyframeOdometry::Keyframe>& keyframe) {
  put(bytes, keyframe.has_value());
  if (!keyframe) return;
  put(bytes, keyframe->stamp_ns);
  put(bytes, keyframe->wheel_from_base);
  put(bytes, keyframe->odom_from_base);
  put_all(bytes, std::vector<char>(keyframe->scanner_id.begin(), keyframe->scanner_id.end()));
  std::vector<double> coordinates;
  for (const geometry::Vector2& point_m : keyframe->points_in_base_m)
    coordinates.insert(coordinates.end(), {point_m.x(), point_m.y()});
  put_all(bytes, coordinates);
}

std::optional<KeyframeOdometry::Keyframe> keyframe_of(ByteReader& from) {
  bool is_there = false;
  from.get(is_there);
  if (!is_there) return std::nullopt;
  KeyframeOdometry::Keyframe keyframe;
  std::vector<char> scanner_id;
  from.get(keyframe.stamp_ns);
  from.get(keyframe.wheel_from_base);
  from.get(keyframe.odom_from_base);
  from.get_all(scanner_id);
  std::vector<double> coordinates;
  from.get_all(coordinates);
  for (std::size_t i = 0; i + 1 < coordinates.size(); i += 2)
    keyframe.points_in_base_m.emplace_back(coordinates[i], coordinates[i + 1]);
  keyframe.scanner_id.assign(scanner_id.begin(), scanner_id.end());
  return keyframe;
}

}  // namespace

std::vector<std::byte> to_bytes(const LocalizerSnapshot& snapshot) {
  const Checkpoint& checkpoint = snapshot.checkpoint;
  std::vector<std::byte> bytes;
  put(bytes, kMark);
  visit_parts(checkpoint, [&](const auto& part) { put(bytes, part); });
  put_all(bytes, checkpoint.odometry);
  put_keyframe(bytes, checkpoint.keyframes.keyframe);
  put(bytes, checkpoint.keyframes.compared_ns);
  put(bytes, checkpoint.keyframes.is_in_doubt);
  put(bytes, checkpoint.keyframes.rests);
  put(bytes, checkpoint.keyframes.way_ratio);
  snapshot.map.write(bytes);
  put(bytes, checksum(bytes));
  return bytes;
}

std::optional<RestoredCheckpoint> checkpoint_of(std::span<const std::byte> bytes,
                                                const Checkpoint& before,
                                                const LocalMapConfig& config,
                                                work::SideWork* help) {
  const auto content = unsealed(bytes);
  if (!content) return std::nullopt;
  ByteReader from(*content);
  Checkpoint checkpoint = before;
  checkpoint.pose.prediction.last = OdometryPrediction::LastScan{};
  std::uint64_t mark = 0;
  from.get(mark);
  if (mark != kMark) return std::nullopt;
  visit_parts(checkpoint, [&](auto& part) { from.get(part); });
  from.get_all(checkpoint.odometry);
  checkpoint.keyframes.keyframe = keyframe_of(from);
  from.get(checkpoint.keyframes.compared_ns);
  from.get(checkpoint.keyframes.is_in_doubt);
  from.get(checkpoint.keyframes.rests);
  from.get(checkpoint.keyframes.way_ratio);
  std::optional<LocalMap> map = LocalMap::restored(config, from, help);
  if (!map || !from.ok() || !from.at_end() || !is_sound(checkpoint)) return std::nullopt;
  return RestoredCheckpoint{std::move(checkpoint), *std::move(map)};
}

}  // namespace slammot::localization
