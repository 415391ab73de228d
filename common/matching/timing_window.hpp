#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "common/matching/odometry_timing.hpp"

namespace slammot::matching {

/// How the motion of the vehicle changes between two scans.
enum class MotionChange : std::uint8_t { kTurnsMore, kTurnsLess, kFaster, kSlower };
inline constexpr std::size_t kMotionChanges = 4;

/// Whether a pair of such a change tells a turn [rad]; otherwise a way [m].
inline bool is_of_turn(MotionChange change) {
  return change == MotionChange::kTurnsMore || change == MotionChange::kTurnsLess;
}

/// Delays of odometry at which the motion between two scans is looked up.
struct TimingDelays {
  static constexpr std::size_t kCount = 81;
  static constexpr double kStep_s = 0.01;
  static constexpr double kReach_s = 0.4;

  static double at(std::size_t i) { return kStep_s * static_cast<double>(i) - kReach_s; }
};

/// A turn or a way between two scans, by registration and by odometry.
struct TimedQuantity {
  MotionChange change = MotionChange::kTurnsMore;  ///< Says whether it is turn or way.
  double by_scans = 0.0;
  double sigma = 1.0;
  std::array<float, TimingDelays::kCount> by_odometry{};  ///< Read so much later than stamped.
};

/// How well the delays explain the quantities of a window.
struct TimingEvidence {
  OdometryTiming timing;
  std::array<double, TimingDelays::kCount> errors{};  ///< Squared, by delay.
  double usual_error = 1.0;                           ///< Of one quantity at the best delay.

  /// By how much the best delay explains the quantities better than this one, in units of the
  /// usual error: chi-square with one degree of freedom, if this one is right.
  double gain_over(double delay_s) const;
};

/// Lateness of odometry's stamps against those of the scans, while driving: odometry_timing() over
/// the last pairs between which speed or turn rate changed, without their scans. Bounded memory,
/// none allocated after construction.
class TimingWindow {
 public:
  /// The oldest one of the same change is forgotten.
  void add(const TimedQuantity& quantity);

  /// None where the quantities are too few or do not determine it.
  std::optional<TimingEvidence> evidence() const;

  std::size_t size() const;

 private:
  static constexpr std::size_t kMostOfAKind = 8;  // few, so that another lateness is found soon
  struct Kind {
    std::array<TimedQuantity, kMostOfAKind> last;
    std::size_t count = 0;  ///< Ever added.

    std::size_t size() const { return count < kMostOfAKind ? count : kMostOfAKind; }
  };

  /// One of each quantity, without memory of its own.
  template <typename Entry>
  struct Entries {
    std::array<Entry, kMotionChanges * kMostOfAKind> all;
    std::size_t count = 0;

    std::span<const Entry> used() const { return {all.data(), count}; }
  };

  double error_at(std::size_t delay, bool of_turns) const;
  double information_at(std::size_t delay, bool of_turns) const;
  template <typename Entry, typename EntryOf>
  Entries<Entry> collect(bool of_turns, EntryOf entry_of) const;

  std::vector<Kind> kinds_ = std::vector<Kind>(kMotionChanges);
};

}  // namespace slammot::matching
