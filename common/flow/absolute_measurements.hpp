#pragma once

#include <cstddef>
#include <cstdint>

#include "common/geometry/geodetic.hpp"
#include "common/geometry/pose2.hpp"

namespace slammot::flow {

/// Limits of one submap: fixes and readings beyond them are left out.
inline constexpr std::size_t kMostFixesOfSubmap = 64;
inline constexpr std::size_t kMostHeadingsOfSubmap = 128;

/// A fix of the satellite receiver, taken while a submap was in use.
struct SubmapFix {
  float x_m = 0.0F;  ///< Position of the base in the submap's frame, by the scans.
  float y_m = 0.0F;
  geometry::Geodetic position;    ///< Of the base, by the receiver.
  float east_variance_m2 = 0.0F;  ///< As the receiver believes.
  float north_variance_m2 = 0.0F;
  float covariance_m2 = 0.0F;  ///< Of east and north.
};

/// A compass reading, taken while a submap was in use.
struct SubmapHeading {
  float in_submap_rad = 0.0F;  ///< Heading of the base in the submap's frame, by the scans.
  float from_east_rad = 0.0F;  ///< The same from east, counter-clockwise, by the compass.
  float sigma_rad = 0.0F;      ///< As the compass believes.
};

/// What GNSS and compass say of the map as a whole.
struct Georeference {
  bool has_position = false;      ///< `origin` is valid.
  bool has_direction = false;     ///< `x_from_east_rad` is valid.
  geometry::Geodetic origin;      ///< Of the frame map.
  double x_from_east_rad = 0.0;   ///< Direction of the map's x axis, counter-clockwise from east.
  double position_sigma_m = 0.0;  ///< Of the origin, per axis, one sigma.
  double direction_sigma_rad = 0.0;
  double compass_bias_rad = 0.0;  ///< Of the compass's readings, as estimated; 0 without GNSS.
  double fix_sigma_m = 0.0;       ///< Error of the fixes in use, per axis, as estimated.
  bool corrects_map = false;      ///< The poses of the submaps are corrected by the measurements.
  std::uint32_t fixes = 0;
  std::uint32_t rejected_fixes = 0;  ///< As outliers: multipath.
  std::uint32_t headings = 0;
  std::uint32_t rejected_headings = 0;  ///< As outliers: iron near the compass.
};

}  // namespace slammot::flow
