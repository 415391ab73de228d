#include "common/sensing/steady_stamps.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace slammot::sensing {
namespace {

constexpr std::size_t kFewestScans = 200;
constexpr std::size_t kHalfWindow = 15;     // scans to either side
constexpr double kSlowest_s = 0.2;          // period
constexpr double kRegular_s = 5e-4;         // less noise is left as it is,
constexpr double kRegularPeriods = 0.05;    // as a share of the period, too
constexpr double kNoisiestPeriods = 0.5;    // more is no scanner with a constant period
constexpr double kUsualCorrelation = -0.5;  // of consecutive steps between stamps with white noise
constexpr double kTrimSigmas = 2.5;
constexpr double kSigmaPerDeviation = 1.4826;  // median of absolute deviations of a Gaussian
constexpr std::int64_t kLeastStepNs = 1'000;

double middle_of(std::vector<double>& values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// Median of the differences over many scans, in which noise counts little and a missing scan does
/// not count.
double period_of(std::span<const std::int64_t> stamps_ns) {
  constexpr std::size_t kScans = 2 * kHalfWindow;
  std::vector<double> periods_s;
  for (std::size_t i = kScans; i < stamps_ns.size(); ++i)
    periods_s.push_back(1e-9 * static_cast<double>(stamps_ns[i] - stamps_ns[i - kScans]) / kScans);
  return middle_of(periods_s);
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
    medians.push_back(middle_of(window));
  }
  return medians;
}

/// One sigma of the differences.
double sigma_of(const std::vector<double>& values, const std::vector<double>& others) {
  std::vector<double> deviations;
  for (std::size_t i = 0; i < values.size(); ++i)
    deviations.push_back(std::abs(values[i] - others[i]));
  return kSigmaPerDeviation * middle_of(deviations);
}

/// Of consecutive steps; those across a pause or of a stray stamp do not count.
double correlation_of_steps(const std::vector<double>& offsets_s, double noise_s) {
  const double longest_s = 4.0 * noise_s;
  double product = 0.0;
  double squares = 0.0;
  for (std::size_t i = 2; i < offsets_s.size(); ++i) {
    const double before_s = offsets_s[i - 1] - offsets_s[i - 2];
    const double step_s = offsets_s[i] - offsets_s[i - 1];
    if (std::abs(before_s) > longest_s || std::abs(step_s) > longest_s) continue;
    product += before_s * step_s;
    squares += step_s * step_s;
  }
  return squares > 0.0 ? product / squares : 0.0;
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

}  // namespace

std::optional<SteadyStamps> steady_stamps(std::span<const std::int64_t> stamps_ns) {
  if (stamps_ns.size() < kFewestScans) return std::nullopt;
  SteadyStamps steady;
  steady.period_s = period_of(stamps_ns);
  if (!(steady.period_s > 0.0) || steady.period_s > kSlowest_s) return std::nullopt;
  const std::vector<double> offsets_s = offsets_of(stamps_ns, steady.period_s);
  const std::vector<double> medians_s = running_median(offsets_s);
  steady.noise_s = sigma_of(offsets_s, medians_s);
  if (steady.noise_s < std::max(kRegular_s, kRegularPeriods * steady.period_s) ||
      steady.noise_s > kNoisiestPeriods * steady.period_s ||
      correlation_of_steps(offsets_s, steady.noise_s) > 0.5 * kUsualCorrelation)
    return std::nullopt;
  for (std::size_t i = 0; i < stamps_ns.size(); ++i) {
    const double offset_s =
        trimmed_mean(around(offsets_s, i), medians_s[i], kTrimSigmas * steady.noise_s);
    const std::int64_t stamp_ns =
        stamps_ns.front() +
        std::llround(1e9 * (offset_s + steady.period_s * static_cast<double>(i)));
    steady.stamps_ns.push_back(i == 0 ? stamp_ns
                                      : std::max(stamp_ns, steady.stamps_ns.back() + kLeastStepNs));
  }
  return steady;
}

}  // namespace slammot::sensing
