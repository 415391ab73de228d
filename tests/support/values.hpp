#pragma once

#include <limits>
#include <random>

#include "common/flow/graph_correction.hpp"
#include "common/flow/localized_scan.hpp"
#include "common/flow/scan_labels.hpp"
#include "common/flow/segmented_scan.hpp"
#include "common/flow/submap.hpp"
#include "common/flow/tracked_objects.hpp"
#include "common/sensing/scan.hpp"
#include "common/traffic/way.hpp"

/// Values in which every member differs from its default and from the others, so that a member left
/// behind shows.
namespace slammot::testing {

inline constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
inline constexpr float kNanF = std::numeric_limits<float>::quiet_NaN();

using Random = std::mt19937;

inline double number(Random& random) {
  return std::uniform_real_distribution<double>(0.1, 0.9)(random);
}
inline float number_f(Random& random) { return static_cast<float>(number(random)); }
inline geometry::Pose2 pose(Random& random) {
  return {number(random), number(random), number(random)};
}
inline Eigen::Vector2d vector(Random& random) { return {number(random), number(random)}; }
inline Eigen::Vector2f point(Random& random) { return {number_f(random), number_f(random)}; }

template <int kRows>
Eigen::Matrix<double, kRows, kRows> matrix(Random& random) {
  Eigen::Matrix<double, kRows, kRows> result;
  for (int i = 0; i < kRows * kRows; ++i) result(i) = number(random);
  return result;
}

inline geometry::UncertainPose2 uncertain_pose(Random& random) {
  return {pose(random), matrix<3>(random)};
}

inline sensing::LaserScan laser_scan(Random& random, std::size_t beams) {
  sensing::LaserScan scan{.stamp_ns = 1'700'000'000'123'456'789,
                          .sequence = 42,
                          .scanner = {.scanner_id = "rear",
                                      .base_from_laser = pose(random),
                                      .first_beam_rad = -1.5,
                                      .beam_step_rad = -0.01,
                                      .max_range_m = 81.0,
                                      .sweep_s = 0.0267},
                          .range_m = {}};
  for (std::size_t i = 0; i < beams; ++i) scan.range_m.push_back(number_f(random));
  return scan;
}

inline flow::LocalizedScan localized_scan(Random& random, std::size_t beams) {
  flow::LocalizedScan scan{.stamp_ns = 1'700'000'000'123'456'789,
                           .sequence = 42,
                           .scanner_id = "rear",
                           .base_from_laser = pose(random),
                           .max_range_m = 81.0,
                           .beam_step_rad = 0.01,
                           .sweep_s = 0.013,
                           .odom_from_base = uncertain_pose(random),
                           .map_from_odom = pose(random),
                           .speed_mps = -3.0,
                           .yaw_rate_radps = -0.2,
                           .map_id = {1'700'000'000'000'000'001},
                           .submap_id = {7},
                           .submap_from_base = pose(random),
                           .beams = {},
                           .odom_id = {1'700'000'000'000'000'002}};
  for (std::size_t i = 0; i < beams; ++i) {
    scan.beams.push_back({point(random), number_f(random), number_f(random), -number_f(random),
                          number_f(random), static_cast<flow::EndCell>(i % 4)});
  }
  return scan;
}

inline flow::Segment segment(Random& random, std::uint32_t segment_id,
                             std::vector<std::uint16_t> beams) {
  return {.segment_id = segment_id,
          .label = static_cast<flow::PointLabel>(segment_id % 4),
          .beams = std::move(beams),
          .centroid_in_odom_m = vector(random),
          .centroid_covariance_m2 = matrix<2>(random),
          .box_centre_in_odom_m = vector(random),
          .box_heading_rad = number(random),
          .box_length_m = number(random),
          .box_width_m = number(random),
          .moving_share = number(random),
          .occluded_at_start = segment_id % 2 == 0,
          .occluded_at_end = segment_id % 3 == 0};
}

/// Segments of two beams each, as many as fit into the beams but for the last two, which are in
/// none.
inline flow::SegmentedScan segmented_scan(Random& random, std::size_t beams) {
  flow::SegmentedScan scan{.stamp_ns = 1'700'000'000'123'456'789,
                           .sequence = 42,
                           .scanner_id = "rear",
                           .base_from_laser = pose(random),
                           .max_range_m = 81.0,
                           .beam_step_rad = 0.01,
                           .sweep_s = 0.013,
                           .odom_from_base = uncertain_pose(random),
                           .map_from_odom = pose(random),
                           .map_id = {1'700'000'000'000'000'001},
                           .points_in_base_m = {},
                           .range_m = {},
                           .labels = {},
                           .segments = {},
                           .odom_id = {1'700'000'000'000'000'002}};
  for (std::size_t i = 0; i < beams; ++i) {
    scan.points_in_base_m.push_back(point(random));
    scan.range_m.push_back(number_f(random));
    scan.labels.push_back(static_cast<flow::PointLabel>(i % 4));
  }
  for (std::size_t i = 0; i + 3 < beams; i += 2) {
    const auto first = static_cast<std::uint16_t>(i);
    scan.segments.push_back(segment(random, static_cast<std::uint32_t>(i / 2),
                                    {first, static_cast<std::uint16_t>(first + 1)}));
  }
  return scan;
}

inline flow::TrackedObject tracked_object(Random& random, std::uint32_t track_id,
                                          std::size_t contour_points, std::size_t path_points) {
  flow::TrackedObject object{.track_id = {track_id},
                             .confirmed = track_id % 2 == 0,
                             .existence = number(random),
                             .position_in_odom_m = vector(random),
                             .velocity_in_odom_mps = vector(random),
                             .covariance = matrix<4>(random),
                             .acceleration_in_odom_mps2 = vector(random),
                             .heading_in_odom_rad = number(random),
                             .length_m = number(random),
                             .width_m = number(random),
                             .motion = static_cast<flow::Motion>(track_id % 2),
                             .object_class = static_cast<flow::ObjectClass>(track_id % 5),
                             .mode_probability = {0.2, 0.5, 0.3},
                             .first_seen_ns = 1000 + track_id,
                             .last_seen_ns = 2000 + track_id,
                             .contour_in_odom_m = {},
                             .predicted_path = {},
                             .class_probability = {0.1, 0.2, 0.3, 0.4}};
  for (std::size_t i = 0; i < contour_points; ++i)
    object.contour_in_odom_m.push_back(point(random));
  for (std::size_t i = 0; i < path_points; ++i) {
    object.predicted_path.push_back(
        {0.1 * static_cast<double>(i), vector(random), matrix<2>(random)});
  }
  return object;
}

inline flow::TrackedObjects tracked_objects(Random& random, std::uint32_t objects,
                                            std::size_t contour_points = 5,
                                            std::size_t path_points = 3) {
  flow::TrackedObjects tracks{.stamp_ns = 1'700'000'000'123'456'789,
                              .sequence = 42,
                              .map_from_odom = pose(random),
                              .odom_from_base = pose(random),
                              .objects = {},
                              .map_id = {1'700'000'000'000'000'001},
                              .odom_id = {1'700'000'000'000'000'002}};
  for (std::uint32_t i = 0; i < objects; ++i) {
    tracks.objects.push_back(tracked_object(random, i, contour_points, path_points));
  }
  return tracks;
}

inline flow::Submap submap(Random& random, std::uint32_t submap_id, std::uint32_t columns,
                           std::uint32_t rows, std::size_t surfels) {
  flow::Submap map{.submap_id = {submap_id},
                   .first_stamp_ns = 11,
                   .last_stamp_ns = 22,
                   .odom_from_submap = pose(random),
                   .previous_from_submap = uncertain_pose(random),
                   .submap_from_base_at_end = pose(random),
                   .travelled_m = number(random),
                   .cell_size_m = 0.1,
                   .min_x_m = -number(random),
                   .min_y_m = -number(random),
                   .columns = columns,
                   .rows = rows,
                   .so_log_odds = {},
                   .mo_evidence = {},
                   .surfels = {},
                   .saliency = number(random)};
  for (std::size_t i = 0; i < std::size_t{columns} * rows; ++i) {
    map.so_log_odds.push_back(static_cast<std::int8_t>(random()));
    map.mo_evidence.push_back(static_cast<std::uint8_t>(random()));
  }
  for (std::size_t i = 0; i < surfels; ++i) {
    map.surfels.push_back(
        {number_f(random), number_f(random), number_f(random), number_f(random), number_f(random)});
  }
  for (std::size_t i = 0; i < flow::kMostFixesOfSubmap; ++i)
    map.fixes.push_back({number_f(random),
                         number_f(random),
                         {40.0 + 1e-5 * number(random), -80.0},
                         2.0F,
                         3.0F,
                         0.5F});
  for (std::size_t i = 0; i < flow::kMostHeadingsOfSubmap; ++i)
    map.headings.push_back({number_f(random), number_f(random), 0.05F});
  return map;
}

/// A piece of a lane along x, whose members depend on the number of its points.
inline traffic::Way way(traffic::Mover mover, int points) {
  traffic::Way made;
  made.mover = mover;
  made.line = points + 1;
  made.speed_mps = points + 0.25;
  made.speed_spread_mps = 0.5;
  made.width_m = 2.75;
  made.tracks = points + 0.5;
  made.confidence = 0.625;
  for (int i = 0; i < points; ++i) made.points_in_map_m.emplace_back(i + 0.125, -i - 0.5);
  return made;
}

}  // namespace slammot::testing
