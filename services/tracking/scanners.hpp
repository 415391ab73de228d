#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "common/flow/scan_labels.hpp"
#include "common/flow/segmented_scan.hpp"
#include "services/tracking/scan_history.hpp"

namespace slammot::tracking {

/// A scanner is compared with what it saw itself, and gets the labels of its own scans.
struct Scanner {
  std::string scanner_id;
  ScanHistory history;
  std::vector<flow::RestoredPoints> restored;  ///< To be published with the labels of its next
                                               ///< scan.
};

/// The scanners of the vehicle, in the order of their first scans, and the time of the last scan.
class Scanners {
 public:
  /// True for a scan older than the last one, or a second one of the same scanner and stamp.
  bool is_late(const flow::SegmentedScan& scan) const;

  /// Makes the scan's scanner the current one. Returns the time since the last scan of any scanner
  /// [s]; 0 for the first.
  double begin(const flow::SegmentedScan& scan);

  /// Forgets all scanners; the last scan was at this stamp.
  void reset(std::int64_t stamp_ns);

  std::size_t count() const { return scanners_.size(); }
  std::size_t current_index() const { return current_; }
  Scanner& current() { return scanners_[current_]; }
  std::vector<Scanner>& all() { return scanners_; }
  std::int64_t last_stamp_ns() const { return last_stamp_ns_; }

  /// Lists what lasts from scan to scan, to save and load it (memory::StateVisitor).
  static void visit_state(auto& self, auto& visit) {
    visit(self.scanners_, self.current_, self.scanners_at_last_stamp_, self.last_stamp_ns_,
          self.has_scan_);
  }
  /// False for a state that no scans lead to.
  bool is_sound() const;

 private:
  std::vector<Scanner> scanners_;
  std::size_t current_ = 0;
  std::vector<std::size_t> scanners_at_last_stamp_;  ///< Empty after reset().
  std::int64_t last_stamp_ns_ = 0;
  bool has_scan_ = false;
};

}  // namespace slammot::tracking
