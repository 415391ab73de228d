#pragma once

#include <cstdint>
#include <string>

#include "common/geometry/geodetic.hpp"

namespace slammot::sensing {

enum class GnssQuality { no_fix, single, differential, rtk };

/// What a satellite receiver says of where the vehicle's base is.
struct GnssFix {
  std::int64_t stamp_ns = 0;
  std::string receiver_id = "main";
  GnssQuality quality = GnssQuality::no_fix;
  geometry::Geodetic position;  ///< This and the next two only with a fix.
  double altitude_m = 0.0;
  geometry::Matrix2 covariance_m2 = geometry::Matrix2::Zero();  ///< (east, north), as the receiver
                                                                ///< believes.
  double hdop = 0.0;   ///< Horizontal dilution of precision.
  int satellites = 0;  ///< In use.
};

/// What a compass says of where the vehicle looks.
struct CompassReading {
  std::int64_t stamp_ns = 0;
  std::string compass_id = "main";
  double heading_from_east_rad = 0.0;  ///< Of the base's x, counter-clockwise, against true north.
  double sigma_rad = 0.0;
};

/// What a gyro says of how fast the vehicle turns: mean since the reading before.
struct TurnRate {
  std::int64_t stamp_ns = 0;
  double yaw_rate_radps = 0.0;  ///< Counter-clockwise.
};

}  // namespace slammot::sensing
