#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "common/flow/ids.hpp"
#include "common/geometry/uncertain_pose2.hpp"

namespace slammot::flow {

/// State of the local map's cell at the end of a beam.
enum class EndCell : std::uint8_t {
  kNoEcho,    ///< The beam has no echo.
  kUnseen,    ///< The cell is unseen.
  kFree,      ///< The cell was often seen free; an echo in it contradicts the map.
  kOccupied,  ///< A stationary object is in the cell, or within the pose's uncertainty of it.
};

/// expected_range_m is computed for this many beams on each side of an echo that contradicts the
/// map, or for all (LocalizerConfig).
constexpr std::size_t kExpectedAside = 2;

/// One beam after localization: its end point and the map's expectation.
struct LocalizedBeam {
  Eigen::Vector2f point_in_base_m = Eigen::Vector2f::Zero();  ///< End point at the scan's stamp,
                                                              ///< deskewed.
  float range_m = 0.0F;                                       ///< As measured; 0 for no echo.
  float expected_range_m = 0.0F;  ///< To the first occupied cell of the SO-map; max range if none;
                                  ///< 0 if not computed.
  float free_evidence = 0.0F;     ///< Log-odds that the end cell is free (positive: free, negative:
                                  ///< occupied).
  float moving_evidence = 0.0F;  ///< Share of sightings in motion in the end cell (MO-map), [0, 1].
  EndCell end_cell = EndCell::kNoEcho;
};

/// One scan with its pose: the input of detection and tracking.
struct LocalizedScan {
  std::int64_t stamp_ns = 0;
  std::uint32_t sequence = 0;  ///< Of the LaserScan it was made from.
  std::string scanner_id;
  geometry::Pose2 base_from_laser;
  double max_range_m = 0.0;
  double beam_step_rad = 0.0;
  double sweep_s = 0.0;  ///< From the first beam's firing (at the stamp) to the last's.
  geometry::UncertainPose2 odom_from_base;  ///< At the stamp; continuous.
  geometry::Pose2 map_from_odom;            ///< Changes when a loop closes.
  double speed_mps = 0.0;                   ///< Forward speed of the base.
  double yaw_rate_radps = 0.0;
  MapId map_id{};
  SubmapId submap_id;                ///< Local map in use.
  geometry::Pose2 submap_from_base;  ///< Pose in the local map; not affected by loop closing.
  std::vector<LocalizedBeam> beams;  ///< One for each beam of the scan, in its order.
  OdomId odom_id{};
  double local_variance_share = 1.0;  ///< Share of the pose covariance within the local map, (0,
                                      ///< 1]; the rest is common drift.
};

}  // namespace slammot::flow
