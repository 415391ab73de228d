#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "common/flow/segmented_scan.hpp"

namespace slammot::detection {

/// Neighbouring echoes with one label, as indices into the beams of a span.
struct Run {
  std::size_t first = 0;
  std::size_t count = 0;
  bool is_moving = false;
};

/// Splits beams into moving and stationary runs. A beam with unknown label joins the run before it.
/// Runs too short for an object take the label of their neighbours.
void split_by_label(std::span<const std::uint16_t> beams, const flow::SegmentedScan& scan,
                    std::vector<Run>& runs);

}  // namespace slammot::detection
