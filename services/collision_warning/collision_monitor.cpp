#include "services/collision_warning/collision_monitor.hpp"

#include <algorithm>
#include <cmath>

#include "services/collision_warning/encounter.hpp"
#include "services/collision_warning/predicted_motion.hpp"

namespace slammot::collision_warning {
namespace {

using flow::CollisionWarning;
using flow::CollisionWarnings;
using flow::TrackedObject;

/// Slower, the vehicle stands: its driver cannot avoid a contact, to keep clear is up to others.
constexpr double kStandsBelowMps = 0.5;

/// True if the whole object is behind the vehicle's rear: to keep clear is up to it.
bool is_behind(const TrackedObject& object, const geometry::Pose2& odom_from_base,
               const CollisionWarningConfig& config) {
  const OrientedBox box{
      {object.position_in_odom_m.x(), object.position_in_odom_m.y(), object.heading_in_odom_rad},
      object.length_m,
      object.width_m};
  const double rear_m = config.vehicle_centre_ahead_m - 0.5 * config.vehicle_length_m;
  const geometry::Pose2 base_from_box = inverse(odom_from_base) * box.centre;
  const geometry::Vector2 forward_in_box = geometry::rotation(-base_from_box.heading_rad).col(0);
  const double reach_m = 0.5 * (box.length_m * std::abs(forward_in_box.x()) +
                                box.width_m * std::abs(forward_in_box.y()));
  return base_from_box.x_m + reach_m < rear_m;
}

}  // namespace

CollisionWarnings CollisionMonitor::step(const flow::TrackedObjects& tracked) {
  begin_anew_if_needed(tracked);
  vehicle_ = motion_.update(tracked.stamp_ns, tracked.odom_from_base);
  const PredictedBoxes vehicle = predict(vehicle_, config_);
  CollisionWarnings warnings{.stamp_ns = tracked.stamp_ns,
                             .sequence = tracked.sequence,
                             .map_id = tracked.map_id,
                             .odom_id = tracked.odom_id,
                             .horizon_s = config_.horizon_s,
                             .highest_level = flow::WarningLevel::kNone,
                             .objects = {}};
  last_ = warnings;
  for (const TrackedObject& object : tracked.objects) {
    // Of an occluded object neither place nor velocity is certain enough to raise a level.
    if (!object.confirmed || object.occluded || is_behind(object, tracked.odom_from_base, config_))
      continue;
    warnings.objects.push_back(assess(object, vehicle, tracked.stamp_ns));
    warnings.highest_level = std::max(warnings.highest_level, warnings.objects.back().level);
  }
  std::erase_if(followed_, [&](const auto& followed) {
    return followed.second.level.is_over(tracked.stamp_ns, config_);
  });
  return warnings;
}

void CollisionMonitor::begin_anew_if_needed(const flow::TrackedObjects& tracked) {
  if (last_ && last_->map_id == tracked.map_id && last_->odom_id == tracked.odom_id &&
      last_->stamp_ns <= tracked.stamp_ns)
    return;
  motion_ = {};
  followed_.clear();
}

CollisionWarning CollisionMonitor::assess(const TrackedObject& object,
                                          const PredictedBoxes& vehicle, std::int64_t stamp_ns) {
  Followed& followed = followed_[object.track_id];
  const CourseState motion = followed.motion.update(stamp_ns, object);
  const PredictedBoxes boxes = predict(object, motion, road_of(vehicle_), config_);
  const std::optional<Contact> contact = collision_warning::contact(vehicle, boxes);
  const bool stands = std::abs(vehicle_.speed_mps) < kStandsBelowMps;
  const ClosestApproach closest = closest_approach(vehicle, boxes);
  return {.track_id = object.track_id,
          .level = followed.level.update(stamp_ns, stands ? std::nullopt : contact, config_),
          .probability = contact ? contact->probability : 0.0,
          .time_to_collision_s = contact ? contact->after_s : -1.0,
          .closest_distance_m = closest.distance_m,
          .time_to_closest_s = closest.after_s};
}

}  // namespace slammot::collision_warning
