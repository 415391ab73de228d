#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "common/files/carmen_record.hpp"
#include "common/files/log_plan.hpp"
#include "common/matching/odometry_check.hpp"
#include "common/sensing/odometry_sampling.hpp"

namespace slammot::files {

/// Stamps of a kind of record, of both clocks.
struct RecordedStamps {
  std::vector<std::optional<std::int64_t>> ipc_ns;
  std::vector<std::optional<std::int64_t>> logger_ns;

  void add(const CarmenStamps& stamps);
  const std::vector<std::optional<std::int64_t>>& of(LogClock clock) const {
    return clock == LogClock::kIpc ? ipc_ns : logger_ns;
  }
};

/// Poses of a kind of record by odometry, and what they are like.
struct RecordedPoses {
  std::vector<geometry::Pose2> all;
  bool change = false;
  matching::OdometryCheck check;
  sensing::PoseNoise noise;

  void add(const geometry::Pose2& wheel_from_base);
  geometry::Pose2 last() const { return all.empty() ? geometry::Pose2{} : all.back(); }
};

/// ODOM lines, or TRUEPOS lines in their place.
struct OdometryLines {
  RecordedPoses poses;
  RecordedStamps stamps;

  std::size_t count() const { return poses.all.size(); }
};

/// Of both kinds of lines, by OdometryRecordKind.
using OdometryLinesByKind = std::array<OdometryLines, 2>;

/// Lines of one OdometryRecordKind between the scans of a scanner.
struct LinesBetween {
  std::uint32_t since_scan = 0;
  std::vector<std::uint32_t> before_scan;  ///< How many, by scan.
  std::vector<geometry::Pose2> pose_before_scan;
};

}  // namespace slammot::files
