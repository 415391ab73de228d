#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "common/sensing/scan_mark.hpp"

namespace slammot::sensing {

/// Stamps of scans that were rounded, spread within their quantum.
struct SpreadStamps {
  std::vector<std::int64_t> stamps_ns;
  double quantum_s = 0.0;  ///< Rounding interval.
};

/// Spreads stamps as evenly as the way or the number of scans allows, whichever is evener, if they
/// are rounded so coarsely that their steps do not measure the time between scans. nullopt
/// otherwise. stamps_ns: one a scan, at least two, the last one later than the first.
std::optional<SpreadStamps> spread_if_coarse(std::span<const ScanMark> scans,
                                             const std::vector<std::int64_t>& stamps_ns);

}  // namespace slammot::sensing
