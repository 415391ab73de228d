#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "common/geometry/pose2.hpp"
#include "common/matching/point_to_line.hpp"
#include "common/matching/timing_window.hpp"

namespace slammot::localization {

/// The last scans of a drive, and those pairs of them between which the speed or the turn rate
/// changes most: matching::TimingPairs while driving. Scans are kept for as long as a pair may need
/// them. No memory is allocated after construction for scans of up to 512 points.
class TimingScans {
 public:
  /// A scan that was matched.
  struct Scan {
    std::int64_t stamp_ns = 0;
    geometry::Pose2 wheel_from_base;
    geometry::Pose2 odom_from_base;
    std::vector<matching::MatchPoint> points;
  };

  /// Two scans and what changes between them.
  struct Pair {
    const Scan& first;
    const Scan& second;
    matching::MotionChange change;
  };

  TimingScans();

  void add(std::int64_t stamp_ns, const geometry::Pose2& wheel_from_base,
           const geometry::Pose2& odom_from_base, const std::vector<matching::MatchPoint>& points);

  /// The next pair that no later one that overlaps can replace; valid until the next add().
  std::optional<Pair> take();

  /// What comes next has nothing to do with the scans before.
  void clear();

 private:
  struct Candidate {
    std::uint64_t first = 0;  ///< Numbers of scans.
    std::uint64_t second = 0;
    double change = 0.0;  ///< [rad/s] or [m/s].
  };
  struct Rates {
    double turn_radps = 0.0;
    double way_mps = 0.0;
  };

  static constexpr std::size_t kKept = 128;

  const Scan& scan(std::uint64_t number) const { return scans_[number % kKept]; }
  bool is_far(std::uint64_t first, std::uint64_t second) const;
  Rates rates_between(std::uint64_t first, std::uint64_t second) const;
  void offer(const Candidate& candidate, matching::MotionChange change);

  std::vector<Scan> scans_ = std::vector<Scan>(kKept);
  std::uint64_t next_ = 0;
  std::uint64_t earliest_ = 0;  ///< Scan that the newest one may be paired with.
  std::array<std::optional<Candidate>, matching::kMotionChanges> latest_;    ///< Of the largest
                                                                             ///< change of those
                                                                             ///< that overlap,
  std::array<std::optional<Candidate>, matching::kMotionChanges> complete_;  ///< and before it.
};

}  // namespace slammot::localization
