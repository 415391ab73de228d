#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <random>
#include <utility>
#include <vector>

#include "common/stages/localization_stage.hpp"
#include "services/localization/localizer.hpp"
#include "tests/support/synthetic_world.hpp"

namespace slammot::testing {

/// A vehicle that drives through a world of walls, with the truth known.
struct DriveSetup {
  World world;
  Path world_from_base_at;
  double scan_period_s = 0.1;
  std::size_t beams = 181;
  double noise_m = 0.01;
  sensing::Scanner scanner = half_circle_scanner();
  WheelErrors wheels;
  std::vector<geometry::Pose2> convoy_in_base = {};  ///< Trucks of 16 m by 2.5 m that move along.
};

/// Makes the scans and the odometry of a drive, one after the other.
class SimulatedDrive {
 public:
  explicit SimulatedDrive(DriveSetup setup) : setup_(std::move(setup)) {}

  double time_s(std::uint32_t scan) const { return setup_.scan_period_s * scan; }

  /// Truth in the frame that localization calls odom: the base where it was at the first scan.
  geometry::Pose2 odom_from_base(std::uint32_t scan) const {
    return geometry::inverse(setup_.world_from_base_at(0.0)) *
           setup_.world_from_base_at(time_s(scan));
  }

  World world_at(double time_s) const {
    World world = setup_.world;
    for (const geometry::Pose2& truck : setup_.convoy_in_base) {
      const World walls = box(setup_.world_from_base_at(time_s) * truck, 16.0, 2.5);
      world.insert(world.end(), walls.begin(), walls.end());
    }
    return world;
  }

  sensing::LaserScan scan(std::uint32_t number) const {
    std::mt19937 random(number + 1);
    const double start_s = time_s(number);
    sensing::LaserScan scan = scan_along(world_at(start_s), setup_.world_from_base_at, start_s,
                                         setup_.scanner, setup_.beams, setup_.noise_m, random);
    scan.sequence = number;
    return scan;
  }

  /// At the stamp of the scan; ask for them in ascending order.
  sensing::Odometry odometry(std::uint32_t number) {
    for (; wheel_scan_ < number; ++wheel_scan_) {
      const geometry::Pose2 step =
          geometry::inverse(odom_from_base(wheel_scan_)) * odom_from_base(wheel_scan_ + 1);
      wheel_from_base_ =
          wheel_from_base_ * step_by_wheels(step, setup_.scan_period_s, setup_.wheels);
    }
    return {stamp_ns_of(time_s(number)), wheel_from_base_};
  }

  DriveSetup& setup() { return setup_; }

 private:
  DriveSetup setup_;
  std::uint32_t wheel_scan_ = 0;
  geometry::Pose2 wheel_from_base_{100.0, -50.0, 2.0};  // an arbitrary start, as wheels have it
};

/// Labels as a perfect tracker in a world without moving objects gives them.
inline flow::ScanLabels all_stationary(const flow::LocalizedScan& scan) {
  flow::ScanLabels labels{scan.stamp_ns, scan.sequence, scan.scanner_id, {}, {}};
  for (const flow::LocalizedBeam& beam : scan.beams) {
    const bool has_echo = beam.end_cell != flow::EndCell::kNoEcho;
    labels.labels.push_back(has_echo ? flow::PointLabel::kStationary : flow::PointLabel::kNoEcho);
  }
  return labels;
}

/// A map small enough for tests, with the defaults otherwise.
inline localization::LocalizerConfig small_map_config() {
  localization::LocalizerConfig config;
  config.map.side_m = 100.0;
  return config;
}

inline double distance_m(const geometry::Pose2& a, const geometry::Pose2& b) {
  return (a.translation_m() - b.translation_m()).norm();
}

inline double turn_rad(const geometry::Pose2& a, const geometry::Pose2& b) {
  return std::abs(geometry::wrap_angle(a.heading_rad - b.heading_rad));
}

/// Odometry, scan and labels of one scan, the way a whole system delivers them.
inline std::optional<flow::LocalizedScan> drive_one(stages::LocalizationStage& localizer,
                                                    SimulatedDrive& drive, std::uint32_t scan,
                                                    bool with_odometry = true) {
  if (with_odometry) localizer.add_odometry(drive.odometry(scan));
  auto localized = localizer.localize(drive.scan(scan), {});
  if (localized) localizer.integrate(all_stationary(*localized));
  return localized;
}

struct DriveErrors {
  double worst_m = 0.0;
  double worst_rad = 0.0;
};

/// Drives through scans [first, last) and compares each pose with the truth.
inline DriveErrors drive_through(stages::LocalizationStage& localizer, SimulatedDrive& drive,
                                 std::uint32_t first, std::uint32_t last,
                                 bool with_odometry = true) {
  DriveErrors errors;
  for (std::uint32_t scan = first; scan < last; ++scan) {
    const auto localized = drive_one(localizer, drive, scan, with_odometry);
    if (!localized) continue;
    errors.worst_m = std::max(
        errors.worst_m, distance_m(localized->odom_from_base.pose, drive.odom_from_base(scan)));
    errors.worst_rad = std::max(
        errors.worst_rad, turn_rad(localized->odom_from_base.pose, drive.odom_from_base(scan)));
  }
  return errors;
}

}  // namespace slammot::testing
