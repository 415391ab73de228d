#include "common/files/reading_histogram.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>

namespace slammot::files {
namespace {

constexpr std::size_t kMostCodes = 8;  // readings that mean "no echo", by centimetres

std::size_t echo_bins(double max_range_m) {
  return static_cast<std::size_t>(std::max(0.0, max_range_m * 100.0 + 0.5));
}

std::span<const std::uint32_t> echoes_of(const std::vector<std::uint32_t>& count_by_cm,
                                         double max_range_m) {
  return std::span(count_by_cm).first(std::min(echo_bins(max_range_m), count_by_cm.size()));
}

std::uint64_t total_of(std::span<const std::uint32_t> counts) {
  return std::accumulate(counts.begin(), counts.end(), std::uint64_t{0});
}

/// The first bin up to which so large a share of the counts is; 0 if there are none.
std::size_t bin_at_share(std::span<const std::uint32_t> counts, double share) {
  const auto total = static_cast<double>(total_of(counts));
  double below = 0.0;
  for (std::size_t bin = 0; bin < counts.size(); ++bin) {
    below += counts[bin];
    if (below > 0.0 && below >= share * total) return bin;
  }
  return 0;
}

}  // namespace

void ReadingHistogram::add(std::span<const float> readings) {
  readings_ += readings.size();
  if (std::ranges::none_of(readings,
                           [](float reading) { return reading > 0.0F && std::isfinite(reading); }))
    ++scans_without_readings_;
  for (const float reading_m : readings) {
    if (reading_m >= 1.0F && reading_m < static_cast<float>(kUnits))
      ++count_by_unit_[static_cast<std::size_t>(reading_m)];
    const float reading_cm = reading_m * 100.0F + 0.5F;
    if (!(reading_cm >= 1.0F && reading_cm < static_cast<float>(kBins))) continue;
    const auto bin = static_cast<std::size_t>(reading_cm);
    ++count_by_cm_[bin];
    smallest_by_cm_[bin] = std::min(smallest_by_cm_[bin], reading_m);
  }
}

void ReadingHistogram::recount(double unit_m) {
  std::ranges::fill(count_by_cm_, 0);
  std::ranges::fill(smallest_by_cm_, std::numeric_limits<float>::infinity());
  for (std::size_t unit = 1; unit < count_by_unit_.size(); ++unit) {
    const auto reading_m = static_cast<float>(unit) * static_cast<float>(unit_m);
    const auto bin = static_cast<std::size_t>(reading_m * 100.0F + 0.5F);
    if (count_by_unit_[unit] == 0 || bin >= kBins) continue;
    count_by_cm_[bin] += count_by_unit_[unit];
    smallest_by_cm_[bin] = std::min(smallest_by_cm_[bin], reading_m);
  }
}

double ReadingHistogram::range_quantile_m(double max_range_m, double share) const {
  return 0.01 * static_cast<double>(bin_at_share(echoes_of(count_by_cm_, max_range_m), share));
}

double ReadingHistogram::recorded_quantile(double share) const {
  return static_cast<double>(bin_at_share(count_by_unit_, share));
}

double ReadingHistogram::echo_share(double max_range_m) const {
  return static_cast<double>(total_of(echoes_of(count_by_cm_, max_range_m))) /
         static_cast<double>(std::max<std::uint64_t>(1, readings_));
}

bool ReadingHistogram::refutes(double stated_m) const {
  constexpr double kWithin = 1.02;      // of the maximum: codes for "no echo" lie just above it
  constexpr double kLeastShare = 0.02;  // of all readings
  constexpr std::ptrdiff_t kLeastKinds = 50;
  if (stated_m <= 0.0) return false;
  const std::span<const std::uint32_t> counts(count_by_cm_);
  const auto above =
      counts.subspan(std::min(echo_bins(kWithin * stated_m) + 1, count_by_cm_.size()));
  std::vector<std::uint32_t> by_count(above.begin(), above.end());
  std::ranges::sort(by_count, std::greater());
  const std::uint64_t without_codes =
      total_of(std::span(by_count).subspan(std::min(kMostCodes, by_count.size())));
  return without_codes > 0 &&
         static_cast<double>(without_codes) >= kLeastShare * static_cast<double>(readings_) &&
         std::ranges::count_if(above, [](std::uint32_t count) { return count > 0; }) >= kLeastKinds;
}

double ReadingHistogram::max_range_m(double stated_m) const {
  constexpr double kCodeShare = 1e-3;  // of all readings
  constexpr std::uint64_t kCodeCount = 5;
  const auto last = std::find_if(count_by_cm_.rbegin(), count_by_cm_.rend(),
                                 [](std::uint32_t count) { return count > 0; });
  if (last == count_by_cm_.rend()) return stated_m > 0.0 ? stated_m : 1.0;
  const auto last_bin = static_cast<std::size_t>(count_by_cm_.rend() - last) - 1;
  const auto total = static_cast<double>(total_of(count_by_cm_));
  const auto is_code = [&](std::size_t bin) {
    return count_by_cm_[bin] >= kCodeCount && count_by_cm_[bin] >= kCodeShare * total;
  };
  for (std::size_t bin = last_bin - last_bin / 100; bin <= last_bin; ++bin) {
    if (!is_code(bin)) continue;
    const double code_m = static_cast<double>(smallest_by_cm_[bin]);
    return stated_m > 0.0 ? std::min(stated_m, code_m) : code_m;
  }
  return stated_m > 0.0 ? stated_m : 0.01 * static_cast<double>(last_bin + 1);
}

}  // namespace slammot::files
