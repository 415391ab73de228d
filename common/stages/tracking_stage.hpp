#pragma once

#include <cstdint>
#include <map>
#include <string>

#include "common/flow/scan_labels.hpp"
#include "common/flow/segmented_scan.hpp"
#include "common/flow/tracked_objects.hpp"

namespace slammot::stages {

/// Output of tracking for one scan.
struct TrackingResult {
  flow::TrackedObjects objects;
  flow::ScanLabels labels;
};

/// Detection's segments in, tracks and point labels out. The pipeline's configuration selects the
/// implementation (services/slammot/implementations.hpp). An implementation is deterministic, reads
/// no clock and starts no thread.
class TrackingStage {
 public:
  virtual ~TrackingStage() = default;

  /// Takes one scan. Answers every scan, also one that is older than its predecessor: `labels` has
  /// one entry a beam, `objects` holds confirmed and tentative tracks at the scan's stamp, in odom.
  /// Valid until the next call.
  virtual const TrackingResult& step(const flow::SegmentedScan& scan) = 0;

  /// Counters for the report, by name; none ever falls.
  virtual std::map<std::string, std::uint64_t> named_counters() const = 0;
};

}  // namespace slammot::stages
