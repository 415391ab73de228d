#pragma once

#include "services/tracking/scan_history.hpp"
#include "services/tracking/scan_view.hpp"
#include "services/tracking/tracking_config.hpp"

namespace slammot::tracking {

/// What every step of one scan reads: the scan, earlier scans of the same scanner, and the
/// settings.
struct ScanContext {
  const ScanView& view;
  const ScanHistory& history;
  const TrackingConfig& config;

  const flow::SegmentedScan& scan() const { return view.scan(); }
};

}  // namespace slammot::tracking
