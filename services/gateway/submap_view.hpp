#pragma once

#include <cstdint>
#include <string>

#include "common/flow/submap.hpp"

namespace slammot::gateway {

/// More cells of a submap are merged, two by two, three by three and so on.
inline constexpr std::uint64_t kMostCells = std::uint64_t{1} << 20;

/// The seen part of a submap, without surfels, with at most `most_cells`. A merged cell has the
/// strongest evidence of those that were seen: thin walls stay.
flow::Submap reduced(flow::Submap submap, std::uint64_t most_cells = kMostCells);

/// Two bytes a cell, row-major, row 0 lowest, compressed by gzip: evidence of stationary objects
/// + 128 (128: unseen), then evidence of motion.
std::string compressed_cells(const flow::Submap& submap);

}  // namespace slammot::gateway
