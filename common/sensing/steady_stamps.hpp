#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace slammot::sensing {

/// Stamps of a scanner with a constant period, without the noise of the computer that stamped them.
struct SteadyStamps {
  std::vector<std::int64_t> stamps_ns;  ///< One a scan, increasing.
  double noise_s = 0.0;                 ///< One sigma of what was removed.
  double period_s = 0.0;
};

/// Removes noise from the stamps of a scanner that turns at a constant rate: of a computer that is
/// busy, or of a connection that delivers scans in batches. Each stamp becomes the trimmed mean of
/// about 30 around it, each moved by as many periods as there are scans between, so that drift of
/// the clock and missing scans stay. Nothing if the scanner is slower than 5 Hz; if its stamps are
/// regular to 0.5 ms or a twentieth of the period, or most of its steps are; or if the times
/// between scans vary themselves: noise of stamps does not add up from scan to scan, uneven turning
/// does; or if they are regular in another order.
std::optional<SteadyStamps> steady_stamps(std::span<const std::int64_t> stamps_ns);

/// True for scans of a steady scanner that were logged in another order than they were taken in:
/// their stamps are right.
bool are_regular_in_another_order(std::span<const std::int64_t> stamps_ns);

}  // namespace slammot::sensing
