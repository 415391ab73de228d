#include "services/slammot/lost_watch.hpp"

#include <cstdio>
#include <utility>

namespace slammot {

std::optional<std::string> LostWatch::see(double time_s, std::uint32_t scan, bool is_lost,
                                          std::uint64_t maps_begun) {
  if (maps_begun > maps_begun_) {
    maps_begun_ = maps_begun;
    scans_otherwise_ = 0;
    if (std::exchange(is_told_lost_, true)) return std::nullopt;
    return tell_lost(time_s, scan, "began a new part of the map");
  }
  if (is_lost == is_told_lost_) {
    scans_otherwise_ = 0;
    return std::nullopt;
  }
  if (scans_otherwise_++ == 0) {
    since_s_ = time_s;
    since_scan_ = scan;
  }
  if (scans_otherwise_ < kScansToTell) return std::nullopt;
  is_told_lost_ = is_lost;
  scans_otherwise_ = 0;
  if (is_lost) return tell_lost(since_s_, since_scan_, "scans do not match the map");
  if (told_ > kMostTold) return std::nullopt;
  char line[96];
  std::snprintf(line, sizeof line, "          found again at %.1f s (scan %u)", since_s_,
                since_scan_);
  return line;
}

std::optional<std::string> LostWatch::tell_lost(double time_s, std::uint32_t scan,
                                                const char* what) {
  if (told_ > kMostTold) return std::nullopt;
  if (++told_ > kMostTold) return "warning:  lost again; further losses are only counted";
  char line[128];
  std::snprintf(line, sizeof line,
                "warning:  lost at %.1f s (scan %u), %s; likely causes: ", time_s, scan, what);
  return line + likely_causes_;
}

}  // namespace slammot
