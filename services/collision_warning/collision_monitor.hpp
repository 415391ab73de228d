#pragma once

#include <map>
#include <optional>

#include "common/flow/collision_warnings.hpp"
#include "common/flow/tracked_objects.hpp"
#include "services/collision_warning/collision_warning_config.hpp"
#include "services/collision_warning/object_motion.hpp"
#include "services/collision_warning/predicted_motion.hpp"
#include "services/collision_warning/vehicle_motion.hpp"
#include "services/collision_warning/warning_level.hpp"

namespace slammot::collision_warning {

/// Predicts the vehicle and every confirmed object that is not behind it, and warns of contacts.
class CollisionMonitor {
 public:
  explicit CollisionMonitor(const CollisionWarningConfig& config) : config_(config) {}

  /// Encounters with the tracks of one scan. Begins anew in another map or frame odom, and when
  /// stamps go back.
  flow::CollisionWarnings step(const flow::TrackedObjects& tracked);

  const VehicleState& vehicle() const { return vehicle_; }

 private:
  /// An object over time.
  struct Followed {
    ObjectMotion motion;
    LevelOverTime level;
  };

  void begin_anew_if_needed(const flow::TrackedObjects& tracked);
  flow::CollisionWarning assess(const flow::TrackedObject& object, const PredictedBoxes& vehicle,
                                std::int64_t stamp_ns);

  CollisionWarningConfig config_;
  VehicleMotion motion_;
  VehicleState vehicle_;
  std::map<flow::TrackId, Followed> followed_;
  std::optional<flow::CollisionWarnings> last_;  ///< Without its objects; none before the first.
};

}  // namespace slammot::collision_warning
