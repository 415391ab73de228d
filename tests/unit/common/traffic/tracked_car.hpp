#pragma once

#include <cstdint>

#include "common/flow/submap.hpp"
#include "common/flow/tracked_objects.hpp"

namespace slammot::traffic {

/// A car on the line y = 2 of odom, at 10 m/s along x, of ten scans a second.
inline flow::TrackedObjects car_at_scan(int scan, std::uint32_t track_id = 7) {
  flow::TrackedObject car;
  car.track_id = {track_id};
  car.confirmed = true;
  car.position_in_odom_m = {1.0 * scan, 2.0};
  car.velocity_in_odom_mps = {10.0, 0.0};
  car.covariance = 0.01 * Eigen::Matrix4d::Identity();
  car.width_m = 1.8;
  car.class_probability = {0.1, 0.0, 0.7, 0.2};
  flow::TrackedObjects objects;
  objects.stamp_ns = (scan + 1) * 100'000'000LL;
  objects.map_id = {5};
  objects.odom_id = {6};
  objects.objects.push_back(car);
  return objects;
}

/// A submap in use until after the scan.
inline flow::Submap submap_until(int scan, std::uint32_t id,
                                 const geometry::Pose2& odom_from_submap = {}) {
  flow::Submap submap;
  submap.map_id = {5};
  submap.submap_id = {id};
  submap.last_stamp_ns = (scan + 1) * 100'000'000LL;
  submap.odom_from_submap = odom_from_submap;
  return submap;
}

}  // namespace slammot::traffic
