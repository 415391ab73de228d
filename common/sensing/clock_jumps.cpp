#include "common/sensing/clock_jumps.hpp"

#include <algorithm>
#include <cstddef>

#include "common/sensing/stamp_steps.hpp"

namespace slammot::sensing {
namespace {

/// True if the stamps after a backward step stay below the highest one before it.
bool stays_behind(const std::vector<std::int64_t>& stamps, std::size_t at) {
  constexpr std::size_t kFollowing = 10;
  const std::size_t end = std::min(stamps.size(), at + kFollowing);
  return end - at >= 3 &&
         std::all_of(stamps.begin() + static_cast<std::ptrdiff_t>(at),
                     stamps.begin() + static_cast<std::ptrdiff_t>(end),
                     [&](std::int64_t stamp_ns) { return stamp_ns < stamps[at - 1]; });
}

/// True if the stamps after a forward step of more than ten minutes stay ahead. A single early
/// stamp is not a step.
bool stays_ahead(const std::vector<std::int64_t>& stamps, std::size_t at) {
  constexpr std::int64_t kFarAheadNs = 600'000'000'000;
  constexpr std::size_t kFollowing = 3;
  if (at + kFollowing > stamps.size()) return false;
  const std::int64_t before_ns = at > 1 ? std::max(stamps[at - 1], stamps[at - 2]) : stamps[at - 1];
  return std::all_of(stamps.begin() + static_cast<std::ptrdiff_t>(at),
                     stamps.begin() + static_cast<std::ptrdiff_t>(at + kFollowing),
                     [&](std::int64_t stamp_ns) { return stamp_ns - before_ns > kFarAheadNs; });
}

}  // namespace

BridgedStamps without_jumps(const std::vector<std::int64_t>& stamps_ns) {
  BridgedStamps bridged{stamps_ns, 0};
  const std::int64_t period_ns = std::max<std::int64_t>(median_advance_ns(stamps_ns), 1);
  std::int64_t shift_ns = 0;
  for (std::size_t i = 1; i < stamps_ns.size(); ++i) {
    // A backward step after a single early stamp returns to the clock and is not a jump.
    const bool returns =
        i > 1 && stamps_ns[i] < stamps_ns[i - 1] && stamps_ns[i] >= stamps_ns[i - 2];
    if (!returns && ((stamps_ns[i] < stamps_ns[i - 1] && stays_behind(stamps_ns, i)) ||
                     stays_ahead(stamps_ns, i))) {
      ++bridged.jumps;
      shift_ns = bridged.stamps_ns[i - 1] + period_ns - stamps_ns[i];
    }
    bridged.stamps_ns[i] = stamps_ns[i] + shift_ns;
  }
  return bridged;
}

}  // namespace slammot::sensing
