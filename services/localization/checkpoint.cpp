#include "services/localization/checkpoint.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "services/localization/byte_stream.hpp"

namespace slammot::localization {
namespace {

constexpr std::uint64_t kMark = 0x736c616d6d6f7463;  // "slammotc": the last letter counts the forms of a checkpoint
constexpr double kFastestRestored = 1e3;    // m/s or rad/s: no vehicle was faster when the checkpoint was made
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

/// The one list of what a checkpoint holds before odometry and map, in its order. prediction.last is there.
template <typename AnyCheckpoint, typename Visitor>
void visit_parts(AnyCheckpoint& checkpoint, Visitor visit) {
  visit_last(*checkpoint.prediction.last, visit);
  visit_estimate(checkpoint.prediction.estimate, visit);
  visit_estimate(checkpoint.prediction.with_stamp_offset, visit);
  visit(checkpoint.prediction.applies_stamp_offset);
  visit(checkpoint.covariance.factors.of_axis);
  visit(checkpoint.covariance.factors.dead_reckoned);
  visit(checkpoint.covariance.map_change.way_m);
  visit(checkpoint.covariance.map_change.squared_residuals);
  visit(checkpoint.sweep_factor.value);
  visit(checkpoint.sweep_factor.variance);
  visit_submaps(checkpoint.submaps, visit);
  visit(checkpoint.counters);
}

bool is_not_negative(double value) { return value >= 0.0 && std::isfinite(value); }

// Whether they may have been ours.

bool is_sound(const sensing::MotionEstimate& estimate) {
  return is_believable(estimate.odom_from_base) && is_believable(estimate.covariance) && estimate.calibration.norm() < 1.0 &&
         estimate.velocity.norm() < kFastestRestored;
}

bool is_sound(const OdometryPrediction::LastScan& last) {
  return last.trusted_s >= 0.0 && last.stood_s >= 0.0 && std::hypot(last.speed_mps, last.yaw_rate_radps) < kFastestRestored &&
         std::abs(static_cast<double>(last.stamp_ns)) < kFarthestStamp_ns;
}

bool is_sound(const PublishedCovariance::State& covariance) {
  const sensing::VarianceFactors& factors = covariance.factors;
  return factors.of_axis.minCoeff() >= 0.0 && factors.of_axis.allFinite() && factors.dead_reckoned.minCoeff() >= 0.0 && factors.dead_reckoned.maxCoeff() <= 1.0 &&
         is_not_negative(covariance.map_change.way_m) && is_not_negative(covariance.map_change.squared_residuals);
}

bool is_sound(const SubmapSequence::State& submaps) {
  return is_believable(submaps.map_from_odom) && is_believable(submaps.previous_from_submap.pose) && is_believable(submaps.previous_from_submap.covariance) &&
         is_believable(submaps.travel.drift) && std::isfinite(submaps.travel.travelled_m);
}

bool is_sound(const Checkpoint& checkpoint) {
  return is_sound(checkpoint.prediction.estimate) && is_sound(checkpoint.prediction.with_stamp_offset) && is_sound(*checkpoint.prediction.last) &&
         is_sound(checkpoint.covariance) && is_sound(checkpoint.submaps) && std::isfinite(checkpoint.sweep_factor.value) && checkpoint.sweep_factor.variance >= 0.0 &&
         std::ranges::all_of(checkpoint.odometry, [](const sensing::Odometry& sample) { return is_believable(sample.wheel_from_base); });
}

}  // namespace

std::vector<std::byte> to_bytes(const Checkpoint& checkpoint, const LocalMap& map) {
  std::vector<std::byte> bytes;
  put(bytes, kMark);
  visit_parts(checkpoint, [&](const auto& part) { put(bytes, part); });
  put_all(bytes, checkpoint.odometry);
  map.write(bytes);
  put(bytes, checksum(bytes));
  return bytes;
}

std::optional<RestoredCheckpoint> checkpoint_of(std::span<const std::byte> bytes, const Checkpoint& before, const LocalMapConfig& config, work::SideWork* help) {
  const auto content = unsealed(bytes);
  if (!content) return std::nullopt;
  ByteReader from(*content);
  Checkpoint checkpoint = before;
  checkpoint.prediction.last.emplace();
  std::uint64_t mark = 0;
  from.get(mark);
  if (mark != kMark) return std::nullopt;
  visit_parts(checkpoint, [&](auto& part) { from.get(part); });
  from.get_all(checkpoint.odometry);
  std::optional<LocalMap> map = LocalMap::restored(config, from, help);
  if (!map || !from.ok() || !from.at_end() || !is_sound(checkpoint)) return std::nullopt;
  return RestoredCheckpoint{std::move(checkpoint), *std::move(map)};
}

}  // namespace slammot::localization
