#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "services/tracking/polar_view.hpp"

namespace slammot::tracking {

/// Beams of one object in angular order. They are stored ascending, but across the seam of a scan
/// that goes all round the run begins after the widest gap.
struct BeamRun {
  std::size_t start = 0;  ///< Index of the first beam.
  std::uint16_t first = 0;
  std::uint16_t last = 0;
};

/// beams: at least one.
BeamRun run_of(const std::vector<std::uint16_t>& beams, const PolarView& view);

/// Number of beams between the first and the last without an echo.
int gaps_between(const std::vector<std::uint16_t>& beams, const PolarView& view);

/// True if beams between two objects pass beyond both.
bool is_seen_between(const std::vector<std::uint16_t>& a, const std::vector<std::uint16_t>& b,
                     const PolarView& view);

}  // namespace slammot::tracking
