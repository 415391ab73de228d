#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "common/geometry/pose2.hpp"
#include "common/sensing/scan.hpp"

namespace slammot::sensing {

/// Counts how often consecutive scans have the very same pose of odometry: a logger writes the last
/// one that it got.
class HeldPoses {
 public:
  void add(const geometry::Pose2& wheel_from_base);

  /// Twice the number of scans that repeat a pose before nine of ten changes, and one; 0 where
  /// poses are not held. A vehicle that stands repeats its pose, too, but seldom begins to: poses
  /// are held where most changes come after a repetition.
  std::size_t most_scans() const;

 private:
  std::optional<geometry::Pose2> last_;
  std::size_t repeats_ = 0;
  std::vector<std::size_t> repeats_before_change_;
};

/// How much the sideways part of odometry's steps changes from one to the next: wheels do not jump
/// aside, so that this is noise or rounding of the poses.
class PoseNoise {
 public:
  void add(const geometry::Pose2& wheel_from_base);

  /// Mean over the steps of a vehicle that moves; 0 of few.
  double mean_m() const;

 private:
  std::optional<geometry::Pose2> last_;
  std::optional<geometry::Vector2> last_step_m_;
  double changes_m_ = 0.0;
  std::size_t steps_ = 0;
};

/// How much steps along the way differ from one to the next beyond what a vehicle accelerates [m]:
/// poses that were read at other times than they are stamped, while the vehicle drives. Median over
/// the steps of a vehicle that moves; 0 of few. samples: in order of time.
double forward_noise_m(std::span<const Odometry> samples);

/// The same of turns: headings of a compass, not of wheels.
double turn_noise_rad(std::span<const Odometry> samples);

}  // namespace slammot::sensing
