#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "common/flow/segmented_scan.hpp"

namespace slammot::flow {

/// Points of an earlier scan that were labelled moving and are stationary.
struct RestoredPoints {
  std::uint32_t sequence = 0;
  std::vector<std::uint16_t> beams;
};

/// Labels of a scan's points by tracking: they decide which points go to the SO-map and which to
/// the MO-map.
struct ScanLabels {
  std::int64_t stamp_ns = 0;
  std::uint32_t sequence = 0;  ///< Of the scan, counted by its scanner.
  std::string scanner_id;
  std::vector<PointLabel> labels;        ///< One a beam.
  std::vector<RestoredPoints> restored;  ///< At most 64 earlier scans of the same scanner.
};

}  // namespace slammot::flow
