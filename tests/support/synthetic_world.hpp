#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <numbers>
#include <random>
#include <vector>

#include "common/geometry/pose2.hpp"
#include "common/sensing/scan.hpp"

namespace slammot::testing {

struct Wall {
  geometry::Vector2 from_m;
  geometry::Vector2 to_m;
};

/// Everything that stands in the plane. Rays are cast at every wall in turn: slow, and so simple
/// that it can be believed.
using World = std::vector<Wall>;

/// Where the base is, in the world, at a time in seconds.
using Path = std::function<geometry::Pose2(double)>;

/// A closed line of walls through the corners.
inline World polygon(const std::vector<geometry::Vector2>& corners_m) {
  World world;
  for (std::size_t i = 0; i < corners_m.size(); ++i)
    world.push_back({corners_m[i], corners_m[(i + 1) % corners_m.size()]});
  return world;
}

inline World box(const geometry::Pose2& world_from_box, double length_m, double width_m) {
  const double x = 0.5 * length_m, y = 0.5 * width_m;
  std::vector<geometry::Vector2> corners_m;
  for (const geometry::Vector2& corner_m : {geometry::Vector2(x, y), {-x, y}, {-x, -y}, {x, -y}}) {
    corners_m.push_back(world_from_box * corner_m);
  }
  return polygon(corners_m);
}

inline World joined(World a, const World& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

inline World moved(World world, const geometry::Pose2& there_from_here) {
  for (Wall& wall : world) wall = {there_from_here * wall.from_m, there_from_here * wall.to_m};
  return world;
}

/// A room around the origin with a pillar off its centre, so that no two of its corners look alike.
inline World room(double length_m = 16.0, double width_m = 10.0) {
  return joined(box({}, length_m, width_m), box({3.0, 2.0, 0.4}, 1.0, 0.6));
}

/// A street along x, closed at both ends: house fronts 9 m to each side, every one set back a
/// little more or less.
inline World street(double length_m) {
  std::mt19937 random(11);
  World world = box({0.5 * length_m, 0.0, 0.0}, length_m + 60.0, 40.0);
  for (const double side : {-1.0, 1.0}) {
    double x_m = -25.0;
    while (x_m < length_m + 20.0) {
      const double front_m = 6.0 + static_cast<double>(random() % 50) / 10.0;
      const double set_back_m = static_cast<double>(random() % 30) / 10.0;
      world =
          joined(world, box({x_m + 0.5 * front_m, side * (11.0 + set_back_m), 0.0}, front_m, 4.0));
      x_m += front_m + 0.5 + static_cast<double>(random() % 20) / 10.0;
    }
  }
  return world;
}

/// Distance to the first wall; infinity where there is none.
inline double range_m(const World& world, const geometry::Vector2& origin_m, double direction_rad) {
  const geometry::Vector2 direction(std::cos(direction_rad), std::sin(direction_rad));
  double nearest_m = std::numeric_limits<double>::infinity();
  for (const Wall& wall : world) {
    const geometry::Vector2 along_m = wall.to_m - wall.from_m;
    const geometry::Vector2 offset_m = wall.from_m - origin_m;
    const double cross = direction.x() * along_m.y() - direction.y() * along_m.x();
    if (cross == 0.0) continue;
    const double distance_m = (offset_m.x() * along_m.y() - offset_m.y() * along_m.x()) / cross;
    const double share = (offset_m.x() * direction.y() - offset_m.y() * direction.x()) / cross;
    if (distance_m > 0.0 && share >= 0.0 && share <= 1.0)
      nearest_m = std::min(nearest_m, distance_m);
  }
  return nearest_m;
}

/// 181 beams over half a circle to the front, all at once.
inline sensing::Scanner half_circle_scanner(double max_range_m = 50.0) {
  sensing::Scanner scanner;
  scanner.first_beam_rad = -0.5 * std::numbers::pi;
  scanner.beam_step_rad = std::numbers::pi / 180.0;
  scanner.max_range_m = max_range_m;
  return scanner;
}

inline std::int64_t stamp_ns_of(double time_s) { return std::llround(time_s * 1e9); }

/// What the scanner measures while the base moves along the path: each beam from where the laser is
/// when it fires. Echoes beyond the scanner's range read max_range_m.
inline sensing::LaserScan scan_along(const World& world, const Path& world_from_base_at,
                                     double time_s, const sensing::Scanner& scanner,
                                     std::size_t beam_count, double noise_m, std::mt19937& random) {
  std::normal_distribution<double> noise(0.0, 1.0);
  sensing::LaserScan scan;
  scan.stamp_ns = stamp_ns_of(time_s);
  scan.scanner = scanner;
  for (std::size_t beam = 0; beam < beam_count; ++beam) {
    const double fired_s = time_s + sensing::beam_delay_s(scanner, beam, beam_count);
    const geometry::Pose2 world_from_laser = world_from_base_at(fired_s) * scanner.base_from_laser;
    const double direction_rad =
        world_from_laser.heading_rad + sensing::beam_angle_rad(scanner, beam);
    const double exact_m = range_m(world, world_from_laser.translation_m(), direction_rad);
    scan.range_m.push_back(
        static_cast<float>(std::min(exact_m + noise_m * noise(random), scanner.max_range_m)));
  }
  return scan;
}

/// Constant speed and turn rate from a start: exact arcs.
inline Path arc(const geometry::Pose2& start, double speed_mps, double yaw_rate_radps) {
  return [=](double time_s) {
    const double turned_rad = yaw_rate_radps * time_s;
    if (yaw_rate_radps == 0.0) return start * geometry::Pose2{speed_mps * time_s, 0.0, 0.0};
    const double radius_m = speed_mps / yaw_rate_radps;
    return start * geometry::Pose2{radius_m * std::sin(turned_rad),
                                   radius_m * (1.0 - std::cos(turned_rad)), turned_rad};
  };
}

/// The way that wheels with systematic errors believe to have gone from one pose to the next.
struct WheelErrors {
  double scale = 1.0;                    ///< True distance by wheel distance.
  double heading_rate_bias_radps = 0.0;  ///< True turn rate less the one by wheels.
  double askew_rad = 0.0;                ///< True direction of the way, left of the one by wheels.
  double turn_scale = 1.0;               ///< True turn by wheel turn.
};

inline geometry::Pose2 step_by_wheels(const geometry::Pose2& before_from_base, double duration_s,
                                      const WheelErrors& errors) {
  const double missed_rad = errors.heading_rate_bias_radps * duration_s +
                            (1.0 - 1.0 / errors.turn_scale) * before_from_base.heading_rad;
  const geometry::Vector2 moved_m = geometry::rotation(-errors.askew_rad - 0.5 * missed_rad) *
                                    before_from_base.translation_m() / errors.scale;
  return {moved_m.x(), moved_m.y(),
          geometry::wrap_angle(before_from_base.heading_rad - missed_rad)};
}

}  // namespace slammot::testing
