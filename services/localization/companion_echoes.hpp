#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "common/sensing/companions.hpp"
#include "common/sensing/scan.hpp"

namespace slammot::localization {

/// Echoes of what goes along with the vehicle (sensing::Companions), for each scanner by itself.
class CompanionEchoes {
 public:
  /// To be called once for each scan, in their order. wheel_from_base: odometry at the scan;
  /// without it nothing new is found. Beams, ascending; valid until the next call.
  const std::vector<std::size_t>& of(const sensing::LaserScan& scan,
                                     const std::optional<geometry::Pose2>& wheel_from_base);

 private:
  struct Scanner {
    std::string scanner_id;
    sensing::Companions companions;
    std::optional<geometry::Pose2> wheel_from_base;  ///< At its last scan.
  };

  std::vector<Scanner> scanners_;
};

}  // namespace slammot::localization
