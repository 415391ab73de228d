#pragma once

#include <algorithm>
#include <cstdint>
#include <random>

#include "common/flow/submap.hpp"

namespace slammot::testing {

/// A submap whose every member differs from its default, the same for the same arguments. Submap n
/// covers the time from 10 n s to 10 (n + 1) s after the drive's start.
inline flow::Submap example_submap(std::uint32_t id, std::int64_t drive_start_ns = 0,
                                   std::uint32_t columns = 70) {
  std::mt19937 random(id + 1);
  flow::Submap submap;
  submap.map_id = {5};
  submap.submap_id = {id};
  submap.first_stamp_ns = drive_start_ns + std::int64_t{id} * 10'000'000'000;
  submap.last_stamp_ns = submap.first_stamp_ns + 10'000'000'000;
  submap.odom_from_submap = {10.0 * id, 1.5, 0.1};
  submap.previous_from_submap.pose = {10.0, 0.25, -0.01};
  submap.previous_from_submap.covariance << 0.04, 0.01, 0.001, 0.01, 0.09, -0.002, 0.001, -0.002,
      0.0016;
  submap.submap_from_base_at_end = {9.5, 0.2, -0.02};
  submap.travelled_m = 9.75;
  submap.cell_size_m = 0.2;
  submap.min_x_m = -30.0;
  submap.min_y_m = -25.0;
  submap.columns = columns;
  submap.rows = columns / 2;
  for (std::uint32_t cell = 0; cell < submap.columns * submap.rows; ++cell) {
    submap.so_log_odds.push_back(static_cast<std::int8_t>(random() % 256));
    submap.mo_evidence.push_back(static_cast<std::uint8_t>(random() % 256));
  }
  for (int i = 0; i < 40; ++i) {
    const float shift = static_cast<float>(random() % 1000) / 100.0F;
    submap.surfels.push_back({shift, -shift, 0.6F, 0.8F, shift + 1.0F});
  }
  submap.saliency = 0.375;
  submap.fixes = {{1.5F, -2.5F, {40.25, -79.5}, 2.0F, 3.0F, 0.5F},
                  {4.5F, -2.5F, {40.25, -79.25}, 2.0F, 3.0F, -0.5F}};
  submap.headings = {{0.25F, -0.5F, 0.125F}};
  return submap;
}

inline bool same_fix(const flow::SubmapFix& a, const flow::SubmapFix& b) {
  return a.x_m == b.x_m && a.y_m == b.y_m && a.position.latitude_deg == b.position.latitude_deg &&
         a.position.longitude_deg == b.position.longitude_deg &&
         a.east_variance_m2 == b.east_variance_m2 && a.north_variance_m2 == b.north_variance_m2 &&
         a.covariance_m2 == b.covariance_m2;
}

inline bool same_heading(const flow::SubmapHeading& a, const flow::SubmapHeading& b) {
  return a.in_submap_rad == b.in_submap_rad && a.from_east_rad == b.from_east_rad &&
         a.sigma_rad == b.sigma_rad;
}

inline bool same_surfel(const flow::Surfel& a, const flow::Surfel& b) {
  return a.x_m == b.x_m && a.y_m == b.y_m && a.normal_x == b.normal_x && a.normal_y == b.normal_y &&
         a.weight == b.weight;
}

/// Bit for bit.
inline bool same_submap(const flow::Submap& a, const flow::Submap& b) {
  return a.map_id == b.map_id && a.submap_id == b.submap_id &&
         a.first_stamp_ns == b.first_stamp_ns && a.last_stamp_ns == b.last_stamp_ns &&
         a.odom_from_submap == b.odom_from_submap &&
         a.previous_from_submap.pose == b.previous_from_submap.pose &&
         a.previous_from_submap.covariance == b.previous_from_submap.covariance &&
         a.submap_from_base_at_end == b.submap_from_base_at_end && a.travelled_m == b.travelled_m &&
         a.cell_size_m == b.cell_size_m && a.min_x_m == b.min_x_m && a.min_y_m == b.min_y_m &&
         a.columns == b.columns && a.rows == b.rows && a.so_log_odds == b.so_log_odds &&
         a.mo_evidence == b.mo_evidence &&
         std::equal(a.fixes.begin(), a.fixes.end(), b.fixes.begin(), b.fixes.end(), same_fix) &&
         std::equal(a.headings.begin(), a.headings.end(), b.headings.begin(), b.headings.end(),
                    same_heading) &&
         std::equal(a.surfels.begin(), a.surfels.end(), b.surfels.begin(), b.surfels.end(),
                    same_surfel) &&
         a.saliency == b.saliency;
}

}  // namespace slammot::testing
