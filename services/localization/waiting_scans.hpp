#pragma once

#include <compare>
#include <cstddef>
#include <cstdint>
#include <deque>

#include "common/sensing/scan.hpp"

namespace slammot::localization {

struct WaitingScan {
  sensing::LaserScan scan;
  std::uint64_t drive_id = 0;
  std::int64_t published_ns = 0;  ///< By the system clock of its source.
  int turns = 0;                  ///< Of the service's loop since it came.
};

/// State of the localizer on which the oldest waiting scan depends.
struct Awaited {
  bool has_odometry = false;    ///< Of the time of the scan.
  bool awaits_labels = false;   ///< Of an earlier scan.
  bool is_first = false;        ///< No scan has been localized.
  bool is_back = false;         ///< Scans since a checkpoint are localized again.
  bool awaits_history = false;  ///< What tracking said about this scan before the restart.
};

/// Scans in the order of arrival. Each waits some turns of the service's loop for odometry of its
/// time and for what tracking says about the scan before it. Turns, not time: on a slow machine
/// odometry that is there is read before a scan is localized without it.
class WaitingScans {
 public:
  void add(WaitingScan scan) { scans_.push_back(std::move(scan)); }
  void count_turn();

  bool empty() const { return scans_.empty(); }
  std::size_t size() const { return scans_.size(); }
  const WaitingScan& oldest() const { return scans_.front(); }
  void drop_oldest() { scans_.pop_front(); }

  void note_odometry() { without_odometry_ = 0; }
  void note_objects(std::int64_t stamp_ns, bool awaits_labels);
  void note_labels(std::int64_t stamp_ns, bool awaits_labels);

  /// True if the oldest scan need not wait any more. Precondition: not empty.
  bool may_begin(const Awaited& awaited) const;

  /// Removes the oldest scan; counts what it awaited in vain.
  WaitingScan take(const Awaited& awaited);

 private:
  /// Scans of several scanners may share a stamp.
  struct Newest {
    std::int64_t stamp_ns = 0;
    int arrivals = 0;  ///< Of this stamp.

    void note(std::int64_t of_stamp_ns) {
      arrivals = of_stamp_ns == stamp_ns ? arrivals + 1 : 1;
      stamp_ns = of_stamp_ns;
    }
    auto operator<=>(const Newest&) const = default;
  };

  bool awaits_odometry(const Awaited& awaited) const;
  bool awaits_tracking(const Awaited& awaited) const;
  bool awaits_history(const Awaited& awaited) const;
  bool is_tracking_late(bool awaits_labels) const;

  std::deque<WaitingScan> scans_;
  int without_odometry_ = 0;  ///< Scans in a row that awaited it in vain,
  int without_tracking_ = 0;  ///< and those that awaited tracking in vain.
  Newest newest_objects_, newest_labels_;
};

}  // namespace slammot::localization
