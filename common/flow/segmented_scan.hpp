#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "common/flow/ids.hpp"
#include "common/geometry/uncertain_pose2.hpp"

namespace slammot::flow {

enum class PointLabel : std::uint8_t {
  kNoEcho,
  kStationary,
  kMoving,
  kUnknown,  ///< The map has no evidence here.
};

/// A segment: neighbouring echoes of one scan that may be one object.
struct Segment {
  std::uint32_t segment_id = 0;  ///< Index in the scan.
  PointLabel label = PointLabel::kUnknown;
  std::vector<std::uint16_t> beams;  ///< Ascending; across the seam of a full-circle scan the last
                                     ///< beams come first.
  Eigen::Vector2d centroid_in_odom_m = Eigen::Vector2d::Zero();
  Eigen::Matrix2d centroid_covariance_m2 = Eigen::Matrix2d::Zero();  ///< Of scanner noise and pose.
  Eigen::Vector2d box_centre_in_odom_m = Eigen::Vector2d::Zero();    ///< Of the visible part's
                                                                     ///< oriented box.
  double box_heading_rad = 0.0;  ///< Of the longer side, in odom; the sense is unknown.
  double box_length_m = 0.0;
  double box_width_m = 0.0;
  double moving_share = 0.0;       ///< Share of moving points among those with evidence in the map.
  bool occluded_at_start = false;  ///< The beam before beams.front() is nearer: a part may be
                                   ///< occluded.
  bool occluded_at_end = false;
};

/// One scan cut into segments, including stationary ones.
struct SegmentedScan {
  std::int64_t stamp_ns = 0;
  std::uint32_t sequence = 0;
  std::string scanner_id;
  geometry::Pose2 base_from_laser;
  double max_range_m = 0.0;
  double beam_step_rad = 0.0;
  double sweep_s = 0.0;  ///< From the first beam's firing (at the stamp) to the last's.
  geometry::UncertainPose2 odom_from_base;  ///< Covariance within the local map.
  geometry::Pose2 map_from_odom;
  MapId map_id{};
  std::vector<Eigen::Vector2f> points_in_base_m;  ///< One a beam.
  std::vector<float> range_m;                     ///< One a beam; 0 for no echo.
  std::vector<PointLabel> labels;                 ///< One a beam.
  std::vector<Segment> segments;
  OdomId odom_id{};
};

}  // namespace slammot::flow
