#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "common/sensing/aids.hpp"
#include "common/simulation/drifting_error.hpp"
#include "common/simulation/ray_caster.hpp"

namespace slammot::simulation {

/// GNSS receiver without corrections; the world's x axis points east, y north.
struct GnssConfig {
  double rate_hz = 0.0;           ///< 0: there is none.
  double latitude_deg = 40.4406;  ///< Of the world's origin,
  double longitude_deg = -79.9959;
  double altitude_m = 230.0;
  int satellites = 11;              ///< Above the horizon.
  double lowest_rad = 0.17;         ///< Lower ones are not used.
  double building_height_m = 18.0;  ///< Height of every wall, which hides satellites.
  double antenna_height_m = 1.6;
  double range_error_m = 0.8;  ///< Of one satellite, one sigma, independent for each fix.
  double wander_m = 1.0;       ///< Atmospheric error, one sigma an axis,
  double wander_s = 120.0;     ///< with this correlation time.
  double multipath_m = 12.0;   ///< Multipath error, one sigma an axis, scaled with the share of
                               ///< hidden satellites,
  double multipath_length_m = 15.0;  ///< with this correlation length.
};

/// The satellites that are visible over the buildings determine the fix, its noise and its
/// multipath.
class GnssReceiver {
 public:
  GnssReceiver(const GnssConfig& config, const Outline& stationary_in_world, std::uint64_t seed);

  /// Fix at a position, at this time and distance after the last one. No fix with fewer than four
  /// satellites or a bad geometry.
  sensing::GnssFix fix(const geometry::Pose2& world_from_base, double after_s, double moved_m);

 private:
  struct Satellite {
    double azimuth_rad;  ///< From east, counter-clockwise.
    double elevation_rad;
  };
  bool is_hidden(const Satellite& satellite, const geometry::Vector2& place_in_world) const;

  GnssConfig config_;
  RayCaster buildings_;
  Random random_;
  std::vector<Satellite> satellites_;
  DriftingError wander_east_, wander_north_, multipath_east_, multipath_north_;
};

}  // namespace slammot::simulation
