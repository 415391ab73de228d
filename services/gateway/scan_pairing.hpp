#pragma once

#include <cstddef>
#include <deque>
#include <functional>
#include <string>
#include <vector>

#include "common/flow/localized_scan.hpp"
#include "common/flow/scan_labels.hpp"

namespace slammot::gateway {

/// Joins each localized scan with the labels of tracking, which come later. Scans whose labels do
/// not come in time are passed on without.
class ScanPairing {
 public:
  using Emit =
      std::function<void(const flow::LocalizedScan&, const std::vector<flow::PointLabel>&)>;
  static constexpr std::size_t kMostWaiting = 6;

  explicit ScanPairing(Emit emit) : emit_(std::move(emit)) {}

  void take(flow::LocalizedScan scan);
  void take(const flow::ScanLabels& labels);

 private:
  Emit emit_;
  std::deque<flow::LocalizedScan> waiting_;
};

}  // namespace slammot::gateway
