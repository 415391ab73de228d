#include "common/sensing/steady_stamps.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "common/geometry/order_statistics.hpp"

namespace slammot::sensing {
namespace {

constexpr std::size_t kFewestStamps = 200;
constexpr std::size_t kHalfWindow = 15;   // scans to either side
constexpr double kSlowest_s = 0.2;        // period
constexpr double kRegular_s = 5e-4;       // less noise is left as it is,
constexpr double kRegularPeriods = 0.05;  // as a share of the period, too;
constexpr double kRegularShare = 0.6;     // and where so many steps are the period to this share
constexpr double kNoisiestPeriods = 5.0;  // scans that come in batches of a dozen have 3.5
constexpr double kPausePeriods = 20.0;    // a step this much longer or shorter is a pause or a jump
constexpr std::size_t kApart = 16;        // scans
constexpr double kMostAddedUp = 2.0;  // RMS of the changes over so many scans by that from one to
                                      // the next: noise of stamps has 1, steps that vary themselves
                                      // 4
constexpr double kTrimSigmas = 2.5;
constexpr std::int64_t kLeastStepNs = 1'000;

/// Median of the differences over many scans, in which noise counts little and a missing scan does
/// not count.
double period_of(std::span<const std::int64_t> stamps_ns) {
  constexpr std::size_t kScans = 2 * kHalfWindow;
  std::vector<double> periods_s;
  for (std::size_t i = kScans; i < stamps_ns.size(); ++i)
    periods_s.push_back(1e-9 * static_cast<double>(stamps_ns[i] - stamps_ns[i - kScans]) / kScans);
  return geometry::upper_median_in_place(periods_s);
}

/// Stamps less the periods since the first [s].
std::vector<double> offsets_of(std::span<const std::int64_t> stamps_ns, double period_s) {
  std::vector<double> offsets_s;
  for (std::size_t i = 0; i < stamps_ns.size(); ++i)
    offsets_s.push_back(1e-9 * static_cast<double>(stamps_ns[i] - stamps_ns.front()) -
                        period_s * static_cast<double>(i));
  return offsets_s;
}

std::span<const double> around(const std::vector<double>& values, std::size_t i) {
  const std::size_t first = i < kHalfWindow ? 0 : i - kHalfWindow;
  const std::size_t end = std::min(values.size(), i + kHalfWindow + 1);
  return {values.data() + first, end - first};
}

/// Running median: a missing scan, or a pause of the log, remains a step.
std::vector<double> running_median(const std::vector<double>& values) {
  std::vector<double> medians;
  std::vector<double> window;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const std::span<const double> near = around(values, i);
    window.assign(near.begin(), near.end());
    medians.push_back(geometry::upper_median_in_place(window));
  }
  return medians;
}

/// Without those that are a pause of the log.
double rms_below(double longest, const std::vector<double>& values) {
  double squares = 0.0;
  double count = 0.0;
  for (const double value : values) {
    if (std::abs(value) > longest) continue;
    squares += value * value;
    count += 1.0;
  }
  return count > 0.0 ? std::sqrt(squares / count) : 0.0;
}

std::vector<double> differences(const std::vector<double>& values,
                                const std::vector<double>& others) {
  std::vector<double> all;
  for (std::size_t i = 0; i < values.size(); ++i) all.push_back(values[i] - others[i]);
  return all;
}

/// Of scans so far apart, less the periods between.
std::vector<double> changes_over(std::size_t scans, const std::vector<double>& offsets_s) {
  std::vector<double> changes_s;
  for (std::size_t i = scans; i < offsets_s.size(); ++i)
    changes_s.push_back(offsets_s[i] - offsets_s[i - scans]);
  return changes_s;
}

/// True if most steps are the period: what else there is are missing scans.
bool are_mostly_regular(const std::vector<double>& steps_s, double period_s) {
  const auto regular = std::ranges::count_if(
      steps_s, [&](double step_s) { return std::abs(step_s) < kRegularPeriods * period_s; });
  return static_cast<double>(regular) > kRegularShare * static_cast<double>(steps_s.size());
}

bool are_regular_in_another_order(std::span<const std::int64_t> stamps_ns, double period_s) {
  if (std::ranges::is_sorted(stamps_ns)) return false;
  std::vector<std::int64_t> in_order(stamps_ns.begin(), stamps_ns.end());
  std::ranges::sort(in_order);
  return are_mostly_regular(changes_over(1, offsets_of(in_order, period_s)), period_s);
}

double trimmed_mean(std::span<const double> values, double middle, double farthest) {
  double sum = 0.0;
  double count = 0.0;
  for (const double value : values) {
    if (std::abs(value - middle) > farthest) continue;
    sum += value;
    count += 1.0;
  }
  return count > 0.0 ? sum / count : middle;
}

std::vector<double> smoothed(const std::vector<double>& offsets_s, double noise_s) {
  const std::vector<double> medians_s = running_median(offsets_s);
  std::vector<double> means_s;
  for (std::size_t i = 0; i < offsets_s.size(); ++i)
    means_s.push_back(trimmed_mean(around(offsets_s, i), medians_s[i], kTrimSigmas * noise_s));
  return means_s;
}

}  // namespace

bool are_regular_in_another_order(std::span<const std::int64_t> stamps_ns) {
  if (stamps_ns.size() < kFewestStamps) return false;
  const double period_s = period_of(stamps_ns);
  return period_s > 0.0 && are_regular_in_another_order(stamps_ns, period_s);
}

std::optional<SteadyStamps> steady_stamps(std::span<const std::int64_t> stamps_ns) {
  if (stamps_ns.size() < kFewestStamps) return std::nullopt;
  SteadyStamps steady;
  steady.period_s = period_of(stamps_ns);
  if (!(steady.period_s > 0.0) || steady.period_s > kSlowest_s ||
      are_regular_in_another_order(stamps_ns, steady.period_s))
    return std::nullopt;
  const std::vector<double> offsets_s = offsets_of(stamps_ns, steady.period_s);
  const std::vector<double> steps_s = changes_over(1, offsets_s);
  const double pause_s = kPausePeriods * steady.period_s;
  if (are_mostly_regular(steps_s, steady.period_s) ||
      rms_below(pause_s, changes_over(kApart, offsets_s)) >
          kMostAddedUp * rms_below(pause_s, steps_s))
    return std::nullopt;
  steady.noise_s = rms_below(pause_s, differences(offsets_s, running_median(offsets_s)));
  if (steady.noise_s < std::max(kRegular_s, kRegularPeriods * steady.period_s) ||
      steady.noise_s > kNoisiestPeriods * steady.period_s)
    return std::nullopt;
  // Twice: the mean of a window that is no multiple of a batch has a ripple.
  const std::vector<double> once_s = smoothed(offsets_s, steady.noise_s);
  const std::vector<double> twice_s = smoothed(once_s, steady.noise_s);
  for (std::size_t i = 0; i < stamps_ns.size(); ++i) {
    const std::int64_t stamp_ns =
        stamps_ns.front() +
        std::llround(1e9 * (twice_s[i] + steady.period_s * static_cast<double>(i)));
    steady.stamps_ns.push_back(i == 0 ? stamp_ns
                                      : std::max(stamp_ns, steady.stamps_ns.back() + kLeastStepNs));
  }
  return steady;
}

}  // namespace slammot::sensing
