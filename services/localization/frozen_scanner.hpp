#pragma once

#include <optional>
#include <string>
#include <vector>

#include "common/geometry/pose2.hpp"
#include "common/sensing/scan.hpp"

namespace slammot::localization {

/// Tells a scanner that hangs and gives its last readings again and again, as drivers of lasers do:
/// of a vehicle that moves, no two scans have the same readings to the last digit. Only odometry
/// tells whether it moves.
class FrozenScanner {
 public:
  /// To be asked once of each scan, in their order. wheel_from_base: odometry at the scan; without
  /// it no scan is frozen.
  bool repeats(const sensing::LaserScan& scan,
               const std::optional<geometry::Pose2>& wheel_from_base);

 private:
  struct Readings {
    std::string scanner_id;
    std::vector<float> range_m;
    std::optional<geometry::Pose2> wheel_from_base;  ///< When they came first.
  };

  std::vector<Readings> last_;  ///< One a scanner.
};

}  // namespace slammot::localization
