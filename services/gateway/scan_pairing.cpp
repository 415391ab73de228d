#include "services/gateway/scan_pairing.hpp"

#include <algorithm>

namespace slammot::gateway {

void ScanPairing::take(flow::LocalizedScan scan) {
  waiting_.push_back(std::move(scan));
  while (waiting_.size() > kMostWaiting) {
    emit_(waiting_.front(), {});
    waiting_.pop_front();
  }
}

/// Labels come in the order of the scans: older scans of the same scanner wait in vain.
void ScanPairing::take(const flow::ScanLabels& labels) {
  const auto is_of = [&](const flow::LocalizedScan& scan) {
    return scan.stamp_ns == labels.stamp_ns && scan.scanner_id == labels.scanner_id;
  };
  const auto found = std::ranges::find_if(waiting_, is_of);
  if (found == waiting_.end()) return;
  const flow::LocalizedScan scan = std::move(*found);
  waiting_.erase(found);
  std::erase_if(waiting_, [&](const flow::LocalizedScan& other) {
    return other.scanner_id == scan.scanner_id && other.stamp_ns < scan.stamp_ns;
  });
  emit_(scan, labels.labels);
}

}  // namespace slammot::gateway
