#pragma once

#include <cmath>
#include <numbers>
#include <random>
#include <utility>
#include <vector>

#include "services/localization/local_map.hpp"
#include "services/localization/localizer_config.hpp"
#include "services/localization/scan_points.hpp"
#include "tests/support/synthetic_world.hpp"

namespace slammot::testing {

/// Whole turns of beams in a world, with which a local map is made and matched.
class MappedWorld {
 public:
  static constexpr std::size_t kBeams = 360;

  /// The map is of what is seen from its middle and from 2 m to each side.
  explicit MappedWorld(World world,
                       const localization::LocalizerConfig& config = config_of_small_map())
      : world_(std::move(world)), config_(config), map_(config.map, geometry::Vector2::Zero()) {
    for (int i = 0; i < 30; ++i) {
      const geometry::Vector2 origin_m(2.0 * (i % 3 - 1) + 0.03, 0.02);
      map_.integrate(i, origin_m, rays_from(origin_m), beam_step_rad());
    }
  }

  static localization::LocalizerConfig config_of_small_map() {
    localization::LocalizerConfig config;
    config.map.side_m = 60.0;
    return config;
  }

  sensing::LaserScan scan_at(const geometry::Pose2& odom_from_base) const {
    sensing::LaserScan scan;
    scan.scanner.first_beam_rad = -std::numbers::pi;
    scan.scanner.beam_step_rad = beam_step_rad();
    scan.scanner.max_range_m = 80.0;
    for (std::size_t beam = 0; beam < kBeams; ++beam) {
      const double range =
          range_m(world_, odom_from_base.translation_m(),
                  odom_from_base.heading_rad + sensing::beam_angle_rad(scan.scanner, beam));
      scan.range_m.push_back(static_cast<float>(range));
    }
    return scan;
  }

  /// What is matched of a scan at the pose.
  localization::ScanPoints points_at(const geometry::Pose2& odom_from_base) const {
    localization::ScanPoints points(config_);
    const sensing::LaserScan scan = scan_at(odom_from_base);
    points.begin_scan();
    points.deskew(scan, 0.0, 0.0);
    points.select(scan, odom_from_base, {});
    return points;
  }

  const localization::LocalMap& map() const { return map_; }
  /// For one who goes on mapping; none is left here.
  localization::LocalMap take_map() { return std::move(map_); }
  const localization::LocalizerConfig& config() const { return config_; }

 private:
  static double beam_step_rad() { return 2.0 * std::numbers::pi / kBeams; }

  std::vector<grids::Ray> rays_from(const geometry::Vector2& origin_m) const {
    std::vector<grids::Ray> rays;
    for (std::size_t i = 0; i < kBeams; ++i) {
      const double direction_rad = beam_step_rad() * static_cast<double>(i);
      rays.push_back(
          {origin_m + range_m(world_, origin_m, direction_rad) *
                          geometry::Vector2(std::cos(direction_rad), std::sin(direction_rad)),
           grids::Echo::kStationary});
    }
    return rays;
  }

  World world_;
  localization::LocalizerConfig config_;
  localization::LocalMap map_;
};

}  // namespace slammot::testing
