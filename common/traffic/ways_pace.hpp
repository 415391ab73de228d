#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>

namespace slammot::traffic {

/// When the ways of a map that grows are found again, by the stamps of the data: finding them takes
/// time in proportion to the streams, so that a large map waits longer. The same data has its ways
/// found at the same stamps, however fast it is played.
class WaysPace {
 public:
  /// stamp_ns: of the newest data. Always true before the first time, and after the source's clock
  /// was set back.
  bool is_due(std::int64_t stamp_ns, std::size_t streams) const {
    return !found_ns_ || stamp_ns < *found_ns_ || stamp_ns - *found_ns_ >= pause_ns(streams);
  }

  void found(std::int64_t stamp_ns) { found_ns_ = stamp_ns; }

  static std::int64_t pause_ns(std::size_t streams) {
    return std::max(kLeastPauseNs, kPausePerStreamNs * static_cast<std::int64_t>(streams));
  }

  static constexpr std::int64_t kLeastPauseNs = 2'000'000'000;
  /// Twenty times as long as finding takes, so that it uses 5 % of a core at the recorded rate.
  static constexpr std::int64_t kPausePerStreamNs = 100'000;

 private:
  std::optional<std::int64_t> found_ns_;
};

}  // namespace slammot::traffic
