#pragma once

#include "common/geometry/pose2.hpp"
#include "common/sensing/scan.hpp"
#include "services/localization/local_map.hpp"

namespace slammot::localization {

/// True if the scanner measured next to nothing: the scan has too few echoes for a match, and less
/// than a tenth of those that the map expects at this pose of the vehicle. Its directions without
/// echo then show no free space, and that no object is seen says nothing.
bool is_blind(const sensing::LaserScan& scan, const geometry::Pose2& odom_from_base,
              const LocalMap& map);

}  // namespace slammot::localization
