#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "common/geometry/pose2.hpp"

namespace slammot::sensing {

/// Mounting and beam layout of a planar scanner. It is part of every scan, so that consumers keep
/// no state.
struct Scanner {
  std::string scanner_id = "front";  ///< Frame laser_<scanner_id>; at most 31 characters.
  geometry::Pose2 base_from_laser;
  double first_beam_rad = 0.0;  ///< Direction of beam 0 in the laser frame, counter-clockwise.
  double beam_step_rad = 0.0;   ///< May be negative for a scanner that sweeps clockwise.
  double max_range_m = 0.0;     ///< A reading at or beyond it is "no echo".
  double sweep_s = 0.0;         ///< From the first to the last beam's firing; 0 if unknown or
                                ///< simultaneous.
};

/// One sweep of one scanner.
struct LaserScan {
  std::int64_t stamp_ns = 0;   ///< Firing of the first beam, source clock.
  std::uint32_t sequence = 0;  ///< Counts the scans of this scanner from 0, without gaps at the
                               ///< source.
  Scanner scanner;
  std::vector<float> range_m;  ///< One a beam. No echo: NaN, <= 0 or >= max_range_m.
};

/// Odometry by wheels (and a gyro, if one is fused on the vehicle), integrated from an arbitrary
/// start.
struct Odometry {
  std::int64_t stamp_ns = 0;
  geometry::Pose2 wheel_from_base;  ///< Drifts without bound and may jump if the source restarts.
};

inline constexpr double kRareScans_s = 0.3;  ///< Longer scan periods are rare scans: their errors
                                             ///< are nearly independent.

/// True if the scan measures nothing: it has no beams, or all readings are NaN, so that it does not
/// show free space either. Its pose is predicted only. Where scans are rare, a scan of NaN is a
/// step of dead reckoning like any other. period_s: usual time between scans.
bool is_blank(const LaserScan& scan, double period_s);

/// True if the reading is an echo.
bool is_echo(float range_m, double max_range_m);

/// Direction of a beam in the laser frame.
double beam_angle_rad(const Scanner& scanner, std::size_t beam);

/// Time from the first beam's firing to this one's. beam_count > 1 if sweep_s > 0.
double beam_delay_s(const Scanner& scanner, std::size_t beam, std::size_t beam_count);
double beam_delay_s(double sweep_s, std::size_t beam, std::size_t beam_count);

}  // namespace slammot::sensing
