#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "common/flow/localized_scan.hpp"
#include "common/wire/decoded.hpp"
#include "idl/localization.h"

namespace slammot::wire {

/// Puts localized scans on the wire; keeps its buffers.
class LocalizedScanEncoder {
 public:
  /// scan_published_ns: system clock of the source, 0 where it is unknown. The result is good until
  /// the next call. Throws std::length_error for more than kMostBeams.
  const slammot_LocalizedScan& encode(std::string_view vehicle_id, const flow::LocalizedScan& scan,
                                      std::int64_t scan_published_ns = 0);

 private:
  slammot_LocalizedScan sample_{};
  std::vector<slammot_LocalizedBeam> beams_;
  std::vector<slammot_EndCell> end_cells_;
};

Decoded<flow::LocalizedScan> decode(const slammot_LocalizedScan& sample);

}  // namespace slammot::wire
