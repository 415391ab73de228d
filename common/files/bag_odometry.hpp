#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "common/geometry/pose2.hpp"

namespace slammot::files {

/// When a message of a bag was made and recorded, and which one it is.
struct MessageTimes {
  std::int64_t log_time_ns = 0;
  std::int64_t stamp_ns = 0;
  std::int64_t index = 0;  ///< In the bag.
};

/// Odometry of a bag, one message.
struct BagPose {
  MessageTimes times;
  geometry::Pose2 wheel_from_base;
};

/// How far the clock of odometry's stamps is ahead of that of the scans' [ns], by the times of
/// recording: computers of one vehicle may differ by seconds. 0 unless the lags of both, from stamp
/// to recording, are steady and differ by more than a message is on its way.
std::int64_t odometry_clock_ahead_ns(std::vector<std::int64_t> lags_of_scans_ns,
                                     const std::vector<BagPose>& odometry);

/// Odometry of a bag between its scans, and at their stamps.
class BagOdometry {
 public:
  /// Clock that relates odometry and scans.
  enum class Clock : std::uint8_t { kHeaders, kRecording, kOrder };

  BagOdometry() = default;
  /// poses: in the order of the bag.
  BagOdometry(std::vector<BagPose> poses, Clock clock);

  /// Interpolated if there is none at the scan's stamp; the first or last one beyond them. Identity
  /// without any.
  geometry::Pose2 wheel_from_base_at(const MessageTimes& scan) const;

  /// The next one, by time of recording, without regard to scans; nullptr at the end.
  const BagPose* next() const { return at_ < poses_.size() ? &poses_[at_] : nullptr; }
  void skip() { ++at_; }
  bool comes_before(const BagPose& pose, const MessageTimes& scan) const;

  /// True if a scan has the very same odometry: this one, or one that was passed to note_told().
  bool is_told_by(const MessageTimes* waiting_scan, const BagPose& pose) const;
  /// The scan was returned with its odometry.
  void note_told(const MessageTimes& scan);

 private:
  std::int64_t time_of(const MessageTimes& times) const;
  const BagPose* pose_of(const MessageTimes& scan) const;

  std::vector<BagPose> poses_;  ///< By time of recording.
  std::size_t at_ = 0;
  std::vector<BagPose> by_time_;  ///< The same by the common clock.
  Clock clock_ = Clock::kRecording;
  std::vector<std::int64_t> told_;  ///< Indices of those that scans had; the last ones.
};

}  // namespace slammot::files
