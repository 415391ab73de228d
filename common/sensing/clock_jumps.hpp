#pragma once

#include <cstdint>
#include <vector>

namespace slammot::sensing {

/// Stamps of a clock without its jumps.
struct BridgedStamps {
  std::vector<std::int64_t> stamps_ns;
  std::uint64_t jumps = 0;
};

/// Replaces jumps after which the clock goes on from there by the usual period: backward ones, and
/// forward ones of more than ten minutes. Single late or early stamps are kept. stamps_ns: at least
/// one, whose differences fit into 64 bits.
BridgedStamps without_jumps(const std::vector<std::int64_t>& stamps_ns);

}  // namespace slammot::sensing
