#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include "common/flow/submap.hpp"
#include "common/geometry/pose2.hpp"
#include "common/sensing/aids.hpp"

namespace slammot::localization {

/// Fixes and compass readings of the submap in progress, at the poses that scans gave the vehicle
/// at their stamps. A measurement may come up to some seconds after its stamp. Thinned by distance:
/// a standing vehicle adds none. Not in checkpoints: a crash loses those of the submap in progress.
class SubmapMeasurements {
 public:
  SubmapMeasurements();

  /// Waits for the scan at or after its stamp. Dropped without a fix, or if not finite.
  void add(const sensing::GnssFix& fix);
  void add(const sensing::CompassReading& reading);

  /// The vehicle's pose at a scan; stamps ascend.
  void place(std::int64_t stamp_ns, const geometry::Pose2& odom_from_base);

  /// The vehicle is lost: what was measured before the next pose cannot be placed.
  void lose_place() { poses_.clear(); }

  /// Moves what was placed since the last call into a submap.
  void move_into(flow::Submap& submap);

 private:
  struct StampedPose {
    std::int64_t stamp_ns = 0;
    geometry::Pose2 odom_from_base;
  };
  struct PlacedFix {
    geometry::Vector2 in_odom_m;
    sensing::GnssFix fix;
  };
  struct PlacedReading {
    geometry::Pose2 odom_from_base;
    sensing::CompassReading reading;
  };

  void place(const sensing::GnssFix& fix);
  void place(const sensing::CompassReading& reading);
  bool is_waited_for(std::int64_t stamp_ns) const;
  std::optional<geometry::Pose2> pose_at(std::int64_t stamp_ns) const;

  std::deque<sensing::GnssFix> waiting_fixes_;
  std::deque<sensing::CompassReading> waiting_readings_;
  std::vector<StampedPose> poses_;  ///< The latest ones, ascending; never grows.
  std::vector<PlacedFix> fixes_;
  std::vector<PlacedReading> readings_;
};

}  // namespace slammot::localization
