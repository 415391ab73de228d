#include "services/slammot/lost_watch.hpp"

#include <cstdio>
#include <utility>

namespace slammot {

std::optional<std::string> LostWatch::update(double time_s, std::uint32_t scan, bool is_lost,
                                             std::uint64_t maps_begun) {
  if (is_reported_lost_ && !losses_.empty()) losses_.back().end_s = time_s;
  if (maps_begun > maps_begun_) {
    maps_begun_ = maps_begun;
    scans_in_other_state_ = 0;
    if (std::exchange(is_reported_lost_, true)) return std::nullopt;
    return report_loss(time_s, scan, "began a new part of the map");
  }
  if (is_lost == is_reported_lost_) {
    scans_in_other_state_ = 0;
    return std::nullopt;
  }
  if (scans_in_other_state_++ == 0) {
    since_s_ = time_s;
    since_scan_ = scan;
  }
  if (scans_in_other_state_ < kScansToReport) return std::nullopt;
  is_reported_lost_ = is_lost;
  scans_in_other_state_ = 0;
  if (is_lost) return report_loss(since_s_, since_scan_, "scans do not match the map");
  if (!losses_.empty()) losses_.back().end_s = since_s_;
  if (reports_ > kMaxReports) return std::nullopt;
  char line[96];
  std::snprintf(line, sizeof line, "          found again at %.1f s (scan %u)", since_s_,
                since_scan_);
  return line;
}

std::optional<std::string> LostWatch::report_loss(double time_s, std::uint32_t scan,
                                                  const char* what) {
  losses_.push_back({time_s, time_s});
  if (reports_ > kMaxReports) return std::nullopt;
  if (++reports_ > kMaxReports) return "warning:  lost again; further losses are counted only";
  char line[128];
  std::snprintf(line, sizeof line,
                "warning:  lost at %.1f s (scan %u), %s; likely causes: ", time_s, scan, what);
  return line + likely_causes_;
}

}  // namespace slammot
