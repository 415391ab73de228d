#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <utility>

#include "common/app/input_watch.hpp"

namespace slammot::app {

/// Decides which scans that were done before are answered again. A neighbour that was restarted
/// repeats a series of scans in their order: answering each would flood the bus. The newest scan is
/// always answered, of a series one in a quarter of a second of data. What the bus gives a process
/// that begins are scans of before, which nobody repeated: answers are owed until it has taken
/// them.
class RepeatWatch {
 public:
  /// Time in which the bus gives what it kept.
  static constexpr std::chrono::milliseconds kBegins{300};

  explicit RepeatWatch(SteadyTime begun = std::chrono::steady_clock::now()) : begun_(begun) {}

  /// `newest_ns`: stamp of the newest scan of this scanner that is done.
  bool asks_for_answer(const std::string& scanner_id, std::int64_t stamp_ns, std::int64_t newest_ns,
                       SteadyTime now = std::chrono::steady_clock::now()) {
    constexpr std::int64_t kPeriodNs = 250'000'000;
    if (stamp_ns == newest_ns) return true;
    if (now - begun_ < kBegins) {
      if (owed_.size() < kMostScanners) owed_.insert(scanner_id);
      return false;
    }
    const auto answered = answered_ns_.find(scanner_id);
    const bool is_in_series = answered != answered_ns_.end() && stamp_ns > answered->second &&
                              stamp_ns - answered->second < kPeriodNs;
    if (is_in_series) return false;
    if (answered_ns_.size() >= kMostScanners) answered_ns_.clear();
    answered_ns_[scanner_id] = stamp_ns;
    return true;
  }

  /// Scanners of which answers are owed; to be asked for once, after kBegins.
  std::set<std::string> take_owed() { return std::exchange(owed_, {}); }

 private:
  static constexpr std::size_t kMostScanners = 100;
  SteadyTime begun_;
  std::set<std::string> owed_;
  std::map<std::string, std::int64_t> answered_ns_;  ///< Of the last repeated scan of a scanner.
};

}  // namespace slammot::app
