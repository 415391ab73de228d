#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <vector>

#include "common/flow/submap.hpp"

namespace slammot::testing {

struct Wall {
  geometry::Vector2 from_m;
  geometry::Vector2 to_m;
};

/// Walls in map, and what a scanner in their midst makes of them.
class FloorPlan {
 public:
  void add(const geometry::Vector2& from_m, const geometry::Vector2& to_m) {
    walls_.push_back({from_m, to_m});
  }

  void add_box(const geometry::Vector2& low_m, const geometry::Vector2& high_m) {
    add(low_m, {high_m.x(), low_m.y()});
    add({high_m.x(), low_m.y()}, high_m);
    add(high_m, {low_m.x(), high_m.y()});
    add({low_m.x(), high_m.y()}, low_m);
  }

  /// Wall hit first by a ray of this direction; null when none is.
  const Wall* first_hit(const geometry::Vector2& origin_m, const geometry::Vector2& direction,
                        double& range_m) const {
    const Wall* hit = nullptr;
    range_m = std::numeric_limits<double>::infinity();
    for (const Wall& wall : walls_) {
      const geometry::Vector2 along = wall.to_m - wall.from_m;
      const geometry::Vector2 to_wall = wall.from_m - origin_m;
      const double cross = direction.x() * along.y() - direction.y() * along.x();
      if (std::abs(cross) < 1e-12) continue;
      const double range = (to_wall.x() * along.y() - to_wall.y() * along.x()) / cross;
      const double share = (to_wall.x() * direction.y() - to_wall.y() * direction.x()) / cross;
      if (range <= 0.0 || range >= range_m || share < 0.0 || share > 1.0) continue;
      range_m = range;
      hit = &wall;
    }
    return hit;
  }

 private:
  std::vector<Wall> walls_;
};

struct SubmapMaker {
  double cell_size_m = 0.1;
  double reach_m = 12.0;      ///< Of the scanner.
  double half_side_m = 18.0;  ///< Of the submap.
  double noise_m = 0.01;
  int beams = 720;
};

/// Submap as it would be after scans from these poses, all taken without error of pose; its frame
/// is the first pose.
inline flow::Submap submap_seen_from(const FloorPlan& plan, std::uint32_t id,
                                     const std::vector<geometry::Pose2>& map_from_base,
                                     const SubmapMaker& maker = {}) {
  using geometry::Vector2;
  std::mt19937_64 random(id + 1);
  std::normal_distribution<double> noise(0.0, maker.noise_m);
  flow::Submap submap;
  submap.submap_id = {id};
  submap.cell_size_m = maker.cell_size_m;
  submap.min_x_m = submap.min_y_m = -maker.half_side_m;
  const int side = static_cast<int>(std::lround(2.0 * maker.half_side_m / maker.cell_size_m));
  submap.columns = submap.rows = static_cast<std::uint32_t>(side);
  std::vector<int> log_odds(static_cast<std::size_t>(side) * static_cast<std::size_t>(side), 0);
  struct Echoes {
    Vector2 sum_m = Vector2::Zero();
    Vector2 normal = Vector2::Zero();
    int count = 0;
  };
  std::vector<Echoes> echoes(log_odds.size());
  const geometry::Pose2 submap_from_map = inverse(map_from_base.front());
  const auto index_of = [&](const Vector2& at_m) {
    const int column =
        static_cast<int>(std::floor((at_m.x() + maker.half_side_m) / maker.cell_size_m));
    const int row =
        static_cast<int>(std::floor((at_m.y() + maker.half_side_m) / maker.cell_size_m));
    return column < 0 || row < 0 || column >= side || row >= side ? -1 : row * side + column;
  };
  for (const geometry::Pose2& pose : map_from_base) {
    for (int beam = 0; beam < maker.beams; ++beam) {
      const double angle_rad = 2.0 * std::numbers::pi * beam / maker.beams;
      const Vector2 direction(std::cos(angle_rad), std::sin(angle_rad));
      double range_m = 0.0;
      const Wall* wall = plan.first_hit(pose.translation_m(), direction, range_m);
      const bool has_echo = wall != nullptr && range_m < maker.reach_m;
      if (has_echo) range_m += noise(random);
      for (double at = 0.0; at < std::min(range_m, maker.reach_m) - maker.cell_size_m;
           at += 0.5 * maker.cell_size_m) {
        const int cell = index_of(submap_from_map * Vector2(pose.translation_m() + at * direction));
        if (cell >= 0) log_odds[static_cast<std::size_t>(cell)] -= 1;
      }
      const Vector2 end_m = submap_from_map * Vector2(pose.translation_m() + range_m * direction);
      const int cell = has_echo ? index_of(end_m) : -1;
      if (cell < 0) continue;
      log_odds[static_cast<std::size_t>(cell)] += 16;
      Echoes& here = echoes[static_cast<std::size_t>(cell)];
      here.sum_m += end_m;
      const Vector2 along = (wall->to_m - wall->from_m).normalized();
      here.normal =
          geometry::rotation(submap_from_map.heading_rad) * Vector2(-along.y(), along.x());
      ++here.count;
    }
  }
  for (std::size_t i = 0; i < log_odds.size(); ++i) {
    submap.so_log_odds.push_back(static_cast<std::int8_t>(std::clamp(8 * log_odds[i], -127, 127)));
    submap.mo_evidence.push_back(0);
    if (echoes[i].count == 0) continue;
    const Vector2 mean_m = echoes[i].sum_m / echoes[i].count;
    submap.surfels.push_back({static_cast<float>(mean_m.x()), static_cast<float>(mean_m.y()),
                              static_cast<float>(echoes[i].normal.x()),
                              static_cast<float>(echoes[i].normal.y()),
                              static_cast<float>(echoes[i].count)});
  }
  submap.submap_from_base_at_end = submap_from_map * map_from_base.back();
  for (std::size_t i = 1; i < map_from_base.size(); ++i) {
    submap.travelled_m +=
        (map_from_base[i].translation_m() - map_from_base[i - 1].translation_m()).norm();
  }
  return submap;
}

}  // namespace slammot::testing
