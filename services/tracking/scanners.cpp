#include "services/tracking/scanners.hpp"

#include <algorithm>

namespace slammot::tracking {

bool Scanners::is_late(const flow::SegmentedScan& scan) const {
  if (!has_scan_ || scan.stamp_ns > last_stamp_ns_) return false;
  if (scan.stamp_ns < last_stamp_ns_ || scanners_at_last_stamp_.empty()) return true;
  return std::ranges::any_of(scanners_at_last_stamp_, [&](std::size_t scanner) {
    return scanners_[scanner].scanner_id == scan.scanner_id;
  });
}

double Scanners::begin(const flow::SegmentedScan& scan) {
  const double time_s =
      has_scan_ ? static_cast<double>(scan.stamp_ns - last_stamp_ns_) * 1e-9 : 0.0;
  const auto known = std::ranges::find(scanners_, scan.scanner_id, &Scanner::scanner_id);
  current_ = static_cast<std::size_t>(known - scanners_.begin());
  if (known == scanners_.end()) scanners_.push_back({scan.scanner_id, {}, {}});
  if (!has_scan_ || scan.stamp_ns != last_stamp_ns_) scanners_at_last_stamp_.clear();
  scanners_at_last_stamp_.push_back(current_);
  has_scan_ = true;
  last_stamp_ns_ = scan.stamp_ns;
  return time_s;
}

bool Scanners::is_sound() const {
  const auto is_scanner = [this](std::size_t index) { return index < scanners_.size(); };
  return (scanners_.empty() || is_scanner(current_)) &&
         std::ranges::all_of(scanners_at_last_stamp_, is_scanner) &&
         std::ranges::all_of(scanners_,
                             [](const Scanner& scanner) { return scanner.history.is_sound(); });
}

void Scanners::reset(std::int64_t stamp_ns) {
  scanners_.clear();
  scanners_at_last_stamp_.clear();
  last_stamp_ns_ = stamp_ns;
  has_scan_ = true;
}

}  // namespace slammot::tracking
