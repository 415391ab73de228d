#pragma once

#include <cstddef>
#include <vector>

#include "common/flow/localized_scan.hpp"
#include "common/sensing/scan.hpp"
#include "common/work/side_work.hpp"
#include "services/localization/local_map.hpp"
#include "services/localization/localizer_config.hpp"
#include "services/localization/scan_points.hpp"

namespace slammot::localization {

/// A scan that was localized, and where.
struct ScanToDescribe {
  const sensing::LaserScan& scan;
  const ScanPoints& points;
  const LocalMap& map;
  geometry::UncertainPose2 odom_from_base;
  geometry::Pose2 map_from_odom;
  double speed_mps = 0.0;
  double yaw_rate_radps = 0.0;
  double sweep_s = 0.0;
};

/// Tells of each beam of a localized scan what the local map expected of it.
class ScanDescription {
 public:
  /// help, if any, does half of it; the results are the same with it and without.
  explicit ScanDescription(const LocalizerConfig& config, work::SideWork* help = nullptr)
      : config_(config), help_(help) {}

  /// workspace: any earlier result that nobody needs any more.
  flow::LocalizedScan describe(const ScanToDescribe& described, flow::LocalizedScan workspace);

  /// Directions of the beams of the scan that was described last: unit vectors in odom.
  const std::vector<geometry::Vector2>& beams_in_odom() const { return beams_in_odom_; }

 private:
  void turn_beams(const sensing::LaserScan& scan, double odom_from_laser_rad);
  void look_up_ends(const ScanToDescribe& described, flow::LocalizedScan& localized) const;
  void look_up_ranges(const ScanToDescribe& described, flow::LocalizedScan& localized) const;
  void list_asked_beams(const flow::LocalizedScan& localized);

  LocalizerConfig config_;
  work::SideWork* help_;
  std::vector<geometry::Vector2> beams_in_odom_;
  std::vector<std::size_t> asked_beams_;  ///< Of which it is asked how far the map would have let
                                          ///< them go.
};

}  // namespace slammot::localization
