#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "common/files/run_report.hpp"

namespace slammot {

/// Reports when localization gets lost and recovers. Short losses are not reported; the number of
/// reports is limited.
class LostWatch {
 public:
  explicit LostWatch(std::string likely_causes) : likely_causes_(std::move(likely_causes)) {}

  /// Call after each scan; returns the line to print, if any. `time_s`: since the first scan.
  /// `maps_begun`: number of new map parts begun after permanent losses; each is reported at once.
  std::optional<std::string> update(double time_s, std::uint32_t scan, bool is_lost,
                                    std::uint64_t maps_begun = 0);

  /// Losses so far, also those that were too many to report. The last one ends with the last scan
  /// if localization is still lost.
  const std::vector<files::LossOfPlace>& losses() const { return losses_; }

 private:
  std::optional<std::string> report_loss(double time_s, std::uint32_t scan, const char* what);

  static constexpr int kScansToReport = 5;  ///< Consecutive scans before a report.
  static constexpr int kMaxReports = 10;

  std::string likely_causes_;
  bool is_reported_lost_ = false;
  int scans_in_other_state_ = 0;  ///< Consecutive scans in the state that was not reported.
  double since_s_ = 0.0;
  std::uint32_t since_scan_ = 0;
  int reports_ = 0;
  std::uint64_t maps_begun_ = 0;
  std::vector<files::LossOfPlace> losses_;
};

}  // namespace slammot
