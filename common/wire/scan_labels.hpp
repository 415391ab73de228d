#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

#include "common/flow/scan_labels.hpp"
#include "common/wire/decoded.hpp"
#include "idl/tracking.h"

namespace slammot::wire {

/// Most earlier scans whose points one message can give back, and most points of them together.
inline constexpr std::size_t kMostRestoredScans = 64;
inline constexpr std::size_t kMostRestoredPoints = 32768;

/// Puts scan labels on the wire; keeps its buffers.
class ScanLabelsEncoder {
 public:
  /// scan_published_ns: system clock of the source, 0 where it is unknown. The result is valid
  /// until the next call. Restored scans beyond the limits are dropped, the last ones first: they
  /// stay out of the SO-map like moving points. Throws std::length_error for more than kMostBeams.
  const slammot_ScanLabels& encode(std::string_view vehicle_id, const flow::ScanLabels& labels,
                                   std::int64_t scan_published_ns = 0);

 private:
  void encode_restored(const std::vector<flow::RestoredPoints>& restored);

  slammot_ScanLabels sample_{};
  std::vector<slammot_PointLabel> labels_;
  std::vector<slammot_RestoredPoints> restored_scans_;
  std::vector<std::uint16_t> restored_beams_;
};

Decoded<flow::ScanLabels> decode(const slammot_ScanLabels& sample);

}  // namespace slammot::wire
