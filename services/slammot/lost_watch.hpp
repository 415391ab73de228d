#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace slammot {

/// Says when a drive gets lost and when it is found again, as it happens. A few scans that do not
/// match are not worth a line, nor is the same thing again and again.
class LostWatch {
 public:
  explicit LostWatch(std::string likely_causes) : likely_causes_(std::move(likely_causes)) {}

  /// After each scan, time_s since the first; the line to print, if any. maps_begun: parts of the
  /// map begun so far because the drive was lost for good, which is told at once.
  std::optional<std::string> see(double time_s, std::uint32_t scan, bool is_lost,
                                 std::uint64_t maps_begun = 0);

 private:
  std::optional<std::string> tell_lost(double time_s, std::uint32_t scan, const char* what);

  static constexpr int kScansToTell = 5;  ///< In a row.
  static constexpr int kMostTold = 10;

  std::string likely_causes_;
  bool is_told_lost_ = false;
  int scans_otherwise_ = 0;  ///< In a row, than what was told.
  double since_s_ = 0.0;
  std::uint32_t since_scan_ = 0;
  int told_ = 0;
  std::uint64_t maps_begun_ = 0;
};

}  // namespace slammot
