#pragma once

#include <cmath>
#include <numbers>
#include <vector>

#include "services/loop_closing/loop_closer.hpp"
#include "services/loop_closing/surroundings.hpp"
#include "tests/support/floor_plan.hpp"

namespace slammot::testing {

inline loop_closing::LoopClosingConfig indoor_loop_closing() {
  loop_closing::LoopClosingConfig config;
  config.min_travel_between_m = 15.0;
  config.max_distance_m = 10.0;
  config.sure_within_m = 1.0;
  loop_closing::set_surroundings(config, loop_closing::Surroundings::building);
  config.revisit.astray_window_m = 12.0;
  return config;
}

/// Ring of corridors, 2 m wide, around a block of 20 x 20 m; niches and pillars make every place
/// its own.
inline FloorPlan ring() {
  FloorPlan plan;
  plan.add_box({0, 0}, {20, 20});
  plan.add_box({-2, -2}, {22, 22});
  plan.add_box({3.0, -1.9}, {3.6, -1.5});
  plan.add_box({9.0, -0.4}, {9.8, -0.1});
  plan.add_box({21.3, 4.0}, {21.9, 5.5});
  plan.add_box({20.1, 12.0}, {20.5, 12.6});
  plan.add_box({15.0, 21.2}, {16.0, 21.9});
  plan.add_box({6.0, 20.1}, {6.5, 20.7});
  plan.add_box({-1.9, 16.0}, {-1.2, 16.5});
  plan.add_box({-0.5, 7.0}, {-0.1, 8.2});
  return plan;
}

/// Poses half a metre apart along the middle of the ring's corridors, rounds times about.
inline std::vector<geometry::Pose2> way_around_the_ring(double rounds) {
  std::vector<geometry::Pose2> way;
  geometry::Pose2 pose{-1.0, -1.0, 0.0};
  const int steps = static_cast<int>(rounds * 168.0);
  for (int i = 0; i < steps; ++i) {
    way.push_back(pose);
    const bool at_corner = (i + 1) % 44 == 0;
    pose = pose * geometry::Pose2{0.5, 0.0, 0.0};
    if (at_corner) pose = pose * geometry::Pose2{0.0, 0.0, std::numbers::pi / 2};
  }
  return way;
}

/// The drive cut into submaps of six metres, as a front end saw it whose heading bends by
/// bend_rad_per_m.
inline std::vector<flow::Submap> drive(const FloorPlan& plan,
                                       const std::vector<geometry::Pose2>& map_from_base,
                                       double bend_rad_per_m, double sigma_scale = 1.0) {
  constexpr std::size_t kPoses = 12;
  std::vector<flow::Submap> submaps;
  geometry::Pose2 odom_from_submap;
  for (std::size_t first = 0; first + kPoses < map_from_base.size(); first += kPoses) {
    const auto begin = map_from_base.begin() + static_cast<std::ptrdiff_t>(first);
    flow::Submap submap = submap_seen_from(plan, static_cast<std::uint32_t>(submaps.size()),
                                           {begin, begin + kPoses + 1});
    if (!submaps.empty()) {
      const geometry::Pose2 step =
          submaps.back().submap_from_base_at_end *
          geometry::Pose2{0.0, 0.0, bend_rad_per_m * submaps.back().travelled_m};
      const double position_sigma_m = sigma_scale * 0.05;
      const double heading_sigma_rad = sigma_scale * 0.015;
      submap.previous_from_submap = {step, Eigen::Vector3d(position_sigma_m * position_sigma_m,
                                                           position_sigma_m * position_sigma_m,
                                                           heading_sigma_rad * heading_sigma_rad)
                                               .asDiagonal()};
      odom_from_submap = odom_from_submap * step;
    }
    submap.odom_from_submap = odom_from_submap;
    submaps.push_back(submap);
  }
  return submaps;
}

}  // namespace slammot::testing
