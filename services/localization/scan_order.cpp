#include "services/localization/scan_order.hpp"

#include <algorithm>

namespace slammot::localization {

ScanOrder::Verdict ScanOrder::judge(const sensing::LaserScan& scan,
                                    const std::optional<std::int64_t>& last_stamp_ns) {
  if (!stamps_.believes(scan.stamp_ns)) return Verdict::kFarAhead;
  if (!last_stamp_ns || scan.stamp_ns > *last_stamp_ns) return Verdict::kUsable;
  if (scan.stamp_ns < *last_stamp_ns) return Verdict::kOutOfOrder;
  // After a crash nobody knows whose scan it was.
  const bool is_new =
      !scanners_at_last_.empty() &&
      std::ranges::find(scanners_at_last_, scan.scanner.scanner_id) == scanners_at_last_.end();
  return is_new ? Verdict::kUsable : Verdict::kDuplicate;
}

void ScanOrder::accept(const sensing::LaserScan& scan,
                       const std::optional<std::int64_t>& last_stamp_ns) {
  if (!last_stamp_ns || *last_stamp_ns != scan.stamp_ns) scanners_at_last_.clear();
  scanners_at_last_.push_back(scan.scanner.scanner_id);
}

bool ScanOrder::accept_blank(const sensing::LaserScan& scan) {
  if (last_blank_ns_ && scan.stamp_ns < *last_blank_ns_) return false;
  if (last_blank_ns_ != scan.stamp_ns) scanners_at_last_blank_.clear();
  last_blank_ns_ = scan.stamp_ns;
  if (std::ranges::find(scanners_at_last_blank_, scan.scanner.scanner_id) !=
      scanners_at_last_blank_.end())
    return false;
  scanners_at_last_blank_.push_back(scan.scanner.scanner_id);
  return true;
}

}  // namespace slammot::localization
