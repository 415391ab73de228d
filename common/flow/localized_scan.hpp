#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "common/flow/ids.hpp"
#include "common/geometry/uncertain_pose2.hpp"

namespace slammot::flow {

/// What the local map says about the cell in which a beam ended.
enum class EndCell : std::uint8_t {
  kNoEcho,    ///< The beam came back from nothing.
  kUnseen,    ///< The map cannot say.
  kFree,      ///< Seen free often enough; an echo from here contradicts the map.
  kOccupied,  ///< Something stationary is known here, or within the pose's uncertainty of here.
};

/// The map's range is asked for so many beams to each side of an echo that contradicts it, or for all (LocalizerConfig).
constexpr std::size_t kExpectedAside = 2;

/// One beam after localization: where it ended and what the map expected of it.
struct LocalizedBeam {
  Eigen::Vector2f point_in_base_m = Eigen::Vector2f::Zero();  ///< End point, sweep's motion removed, at the scan's stamp.
  float range_m = 0.0F;            ///< As measured; 0 for no echo.
  float expected_range_m = 0.0F;   ///< To the first occupied cell of the SO-map; max range where there is none; 0 where nobody asked.
  float free_evidence = 0.0F;      ///< Log-odds that the end cell is free (positive: free, negative: occupied).
  float moving_evidence = 0.0F;    ///< In [0, 1]: how often the MO-map saw something moving in the end cell.
  EndCell end_cell = EndCell::kNoEcho;
};

/// One scan with the pose that SLAM gave it: all that detection and tracking need.
struct LocalizedScan {
  std::int64_t stamp_ns = 0;
  std::uint32_t sequence = 0;                   ///< Of the LaserScan it was made from.
  std::string scanner_id;
  geometry::Pose2 base_from_laser;
  double max_range_m = 0.0;
  double beam_step_rad = 0.0;
  double sweep_s = 0.0;                         ///< From the first beam's firing, at the stamp, to the last's.
  geometry::UncertainPose2 odom_from_base;      ///< At the stamp. Never jumps.
  geometry::Pose2 map_from_odom;                ///< Moves when a loop closes.
  double speed_mps = 0.0;                       ///< Forward, of the base.
  double yaw_rate_radps = 0.0;
  MapId map_id{};
  SubmapId submap_id;                           ///< The local map in use,
  geometry::Pose2 submap_from_base;             ///< and the pose in it: what stays true when loops close.
  std::vector<LocalizedBeam> beams;             ///< One for each beam of the scan, in its order.
  OdomId odom_id{};
  double local_variance_share = 1.0;            ///< Of the pose's covariance, what it may be off within the local map; map and pose drift together by the rest. (0, 1]
};

}  // namespace slammot::flow
