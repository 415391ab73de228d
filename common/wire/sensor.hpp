#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

#include "common/sensing/aids.hpp"
#include "common/sensing/scan.hpp"
#include "common/wire/decoded.hpp"
#include "idl/sensor.h"

namespace slammot::wire {

/// Most beams of a scan that the bus carries.
inline constexpr std::size_t kMostBeams = 4096;

/// Puts scans on the wire. Keeps its buffers, so that encoding does not allocate once it has seen
/// the largest scan.
class LaserScanEncoder {
 public:
  /// For the scans of one drive.
  explicit LaserScanEncoder(std::uint64_t drive_id = 0) { sample_.drive_id = drive_id; }

  /// The result is good until the next call. Throws std::length_error for more than kMostBeams.
  const slammot_LaserScan& encode(std::string_view vehicle_id, const sensing::LaserScan& scan);

 private:
  slammot_LaserScan sample_{};
  std::vector<float> ranges_m_;
};

/// Readings themselves are taken as they are: NaN, negative and infinite ones mean "no echo".
Decoded<sensing::LaserScan> decode(const slammot_LaserScan& sample);

slammot_Odometry encode(std::string_view vehicle_id, const sensing::Odometry& odometry);
Decoded<sensing::Odometry> decode(const slammot_Odometry& sample);

slammot_GnssFix encode(std::string_view vehicle_id, const sensing::GnssFix& fix);
Decoded<sensing::GnssFix> decode(const slammot_GnssFix& sample);

slammot_CompassReading encode(std::string_view vehicle_id, const sensing::CompassReading& reading);
Decoded<sensing::CompassReading> decode(const slammot_CompassReading& sample);

}  // namespace slammot::wire
