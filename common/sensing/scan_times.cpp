#include "common/sensing/scan_times.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "common/geometry/order_statistics.hpp"
#include "common/sensing/clock_jumps.hpp"
#include "common/sensing/coarse_stamps.hpp"
#include "common/sensing/stamp_steps.hpp"
#include "common/sensing/steady_stamps.hpp"

namespace slammot::sensing {
namespace {

constexpr std::size_t kFewestJudged = 10;
constexpr std::int64_t kSecondNs = 1'000'000'000;
constexpr double kShareOfMost = 0.95;

using Stamps = std::vector<std::int64_t>;

Stamps present_stamps(std::span<const ScanMark> scans) {
  Stamps stamps;
  for (const ScanMark& scan : scans) {
    if (scan.stamp_ns) stamps.push_back(*scan.stamp_ns);
  }
  return stamps;
}

/// A missing stamp is replaced by that of the scan before.
Stamps filled_stamps(std::span<const ScanMark> scans) {
  Stamps stamps(scans.size());
  std::int64_t last_ns = 0;
  for (const ScanMark& scan : scans) {
    if (!scan.stamp_ns) continue;
    last_ns = *scan.stamp_ns;
    break;
  }
  for (std::size_t i = 0; i < scans.size(); ++i)
    stamps[i] = last_ns = scans[i].stamp_ns.value_or(last_ns);
  return stamps;
}

bool is_constant(const Stamps& stamps) {
  constexpr std::size_t kStampsPerScans = 500;
  Stamps distinct = stamps;
  std::sort(distinct.begin(), distinct.end());
  const auto count =
      static_cast<std::size_t>(std::unique(distinct.begin(), distinct.end()) - distinct.begin());
  return count <= 1 + std::min<std::size_t>(1, stamps.size() / kFewestJudged) +
                      stamps.size() / kStampsPerScans;
}

/// True for integers with a constant step below 5, such as 0, 1, 2.
bool counts_scans(const Stamps& stamps) {
  constexpr std::int64_t kLargestStep = 4;
  const std::int64_t step_ns = median_advance_ns(stamps);
  if (step_ns <= 0) return false;
  for (const std::int64_t unit_ns :
       {kSecondNs, kSecondNs / 1'000, kSecondNs / 1'000'000, std::int64_t{1}}) {
    if (step_ns % unit_ns != 0 || step_ns / unit_ns > kLargestStep) continue;
    if (unit_ns != kSecondNs && stamps.front() / unit_ns > static_cast<std::int64_t>(stamps.size()))
      continue;  // a fast scanner's clock
    return share_of(steps_of(stamps), [=](std::int64_t step) { return step == step_ns; }) >=
           kShareOfMost;
  }
  return false;
}

bool are_whole_seconds(const Stamps& stamps) {
  return share_of(stamps, [](std::int64_t stamp_ns) { return stamp_ns % kSecondNs == 0; }) >=
         kShareOfMost;
}

/// Mean speed by stamps taken as seconds, without pauses; also of stamps that repeat because they
/// are coarse.
double mean_speed_mps(std::span<const ScanMark> scans, const Stamps& stamps, double usual_step_s) {
  constexpr double kPauseSteps = 100.0;
  double way_m = 0.0;
  double time_s = 0.0;
  for (std::size_t i = 1; i < stamps.size(); ++i) {
    const double step_s = 1e-9 * static_cast<double>(stamps[i] - stamps[i - 1]);
    if (step_s < 0.0 || step_s > kPauseSteps * usual_step_s) continue;
    way_m += scans[i].way_m;
    time_s += step_s;
  }
  return time_s > 0.0 ? way_m / time_s : 0.0;
}

/// Log-prior of a value that is spread over decades [nats].
double log_of_decades(double value, double middle, double sigma_decades) {
  return -0.5 * std::pow(std::log10(value / middle) / sigma_decades, 2);
}

/// Numbers per second; 1 for seconds. The unit with the likeliest time between scans and, where
/// odometry moves, speed.
std::int64_t units_per_second(std::span<const ScanMark> scans, const Stamps& stamps) {
  constexpr double kUsualPeriod_s = 0.15;  // 75 Hz to a scan every 20 s are within two and a half
                                           // sigma
  constexpr double kPeriodDecades = 0.8;
  constexpr double kUsualSpeed_mps = 1.6;
  constexpr double kSpeedDecades = 0.6;
  constexpr double kForSeconds = 2.0;          // nats; most logs are in seconds,
  constexpr double kForSecondsIfWhole = -1.0;  // but seldom in whole ones
  const double step = 1e-9 * static_cast<double>(median_advance_ns(stamps));
  if (!(step > 0.0)) return 1;
  const double speed = mean_speed_mps(scans, stamps, step);
  std::int64_t best = 1;
  double most = -std::numeric_limits<double>::infinity();
  for (const std::int64_t units :
       {std::int64_t{1}, std::int64_t{1'000}, std::int64_t{1'000'000}, kSecondNs}) {
    const double numbers = static_cast<double>(units);
    double log_prior = log_of_decades(step / numbers, kUsualPeriod_s, kPeriodDecades);
    if (speed > 0.0) log_prior += log_of_decades(speed * numbers, kUsualSpeed_mps, kSpeedDecades);
    if (units == 1)
      log_prior += are_whole_seconds(stamps) && step >= 5.0 ? kForSecondsIfWhole : kForSeconds;
    if (log_prior <= most) continue;
    most = log_prior;
    best = units;
  }
  return best;
}

/// Differences of such stamps fit into 64 bits.
bool are_in_range(const Stamps& stamps) {
  const auto [least, most] = std::minmax_element(stamps.begin(), stamps.end());
  return *least >= 0 || (*least > -(std::int64_t{1} << 61) && *most < (std::int64_t{1} << 61));
}

ScanTimes without_clock(ClockFault fault) {
  ScanTimes times;
  times.fault = fault;
  times.is_clock = false;
  return times;
}

/// True if nine of ten scans are newer than the one before. The reader handles duplicates and a few
/// late scans.
bool advances_mostly(const Stamps& stamps) {
  return share_of(steps_of(stamps), [](std::int64_t step) { return step > 0; }) >= 0.9;
}

/// Stamps during the repair, with a record of the repairs.
struct Repair {
  ScanTimes times;
  Stamps stamps;

  void note(ClockFault fault) {
    if (times.fault == ClockFault::kNone) times.fault = fault;
    times.stamps_ns = stamps;
  }
};

void mirror_if_backwards(Repair& repair) {
  const Stamps steps = steps_of(repair.stamps);
  const double back = share_of(steps, [](std::int64_t step) { return step < 0; });
  const double forward = share_of(steps, [](std::int64_t step) { return step > 0; });
  if (back <= 9.0 * forward) return;
  const std::int64_t first_ns = repair.stamps.front();
  const std::int64_t last_ns = repair.stamps.back();
  for (std::int64_t& stamp_ns : repair.stamps) stamp_ns = last_ns + (first_ns - stamp_ns);
  repair.note(ClockFault::kBackwards);
}

void convert_unit(std::span<const ScanMark> scans, Repair& repair) {
  const std::int64_t units = units_per_second(scans, repair.stamps);
  if (units == 1) return;
  for (std::int64_t& stamp_ns : repair.stamps) stamp_ns /= units;
  repair.times.unit_s = 1.0 / static_cast<double>(units);
  repair.note(ClockFault::kUnit);
}

void bridge(Repair& repair) {
  BridgedStamps bridged = without_jumps(repair.stamps);
  repair.stamps = std::move(bridged.stamps_ns);
  repair.times.jumps = bridged.jumps;
  if (bridged.jumps > 0) repair.note(ClockFault::kJumps);
}

void spread_coarse(std::span<const ScanMark> scans, Repair& repair) {
  std::optional<SpreadStamps> spread = spread_if_coarse(scans, repair.stamps);
  if (!spread) return;
  repair.stamps = std::move(spread->stamps_ns);
  repair.times.quantum_s = spread->quantum_s;
  repair.note(ClockFault::kCoarse);
}

void remove_noise(Repair& repair) {
  std::optional<SteadyStamps> steady = steady_stamps(repair.stamps);
  if (!steady) return;
  repair.stamps = std::move(steady->stamps_ns);
  repair.times.noise_s = steady->noise_s;
  repair.note(ClockFault::kNoisy);
}

bool jumps_all_the_time(const Repair& repair) {
  return static_cast<double>(repair.times.jumps) >
         0.02 * static_cast<double>(repair.stamps.size()) + 1.0;
}

Stamps evenly_spaced(std::size_t scans, double period_s) {
  Stamps stamps_ns(scans);
  for (std::size_t i = 0; i < scans; ++i)
    stamps_ns[i] = std::llround(1e9 * period_s * static_cast<double>(i));
  return stamps_ns;
}

}  // namespace

ScanTimes judge_scan_stamps(std::span<const ScanMark> scans) {
  const Stamps present = present_stamps(scans);
  if (present.empty() ||
      static_cast<double>(present.size()) < 0.9 * static_cast<double>(scans.size()))
    return without_clock(ClockFault::kAbsent);
  if (scans.size() == 1) return {};
  if (is_constant(present)) return without_clock(ClockFault::kConstant);
  Repair repair{{}, filled_stamps(scans)};
  if (!are_in_range(repair.stamps)) return without_clock(ClockFault::kErratic);
  if (scans.size() == 2)
    return repair.stamps.front() < repair.stamps.back() ? ScanTimes{}
                                                        : without_clock(ClockFault::kErratic);
  mirror_if_backwards(repair);
  if (counts_scans(repair.stamps)) return without_clock(ClockFault::kIndex);
  if (scans.size() >= kFewestJudged) {
    convert_unit(scans, repair);
    bridge(repair);
    if (jumps_all_the_time(repair) || repair.stamps.back() <= repair.stamps.front())
      return without_clock(ClockFault::kErratic);
    spread_coarse(scans, repair);
    if (repair.times.fault != ClockFault::kCoarse) remove_noise(repair);
  }
  return advances_mostly(repair.stamps) ? repair.times : without_clock(ClockFault::kErratic);
}

bool comes_by_time(std::span<const ScanMark> scans) {
  constexpr double kShort = 0.1;  // share of the 90th percentile below which a way is short
  constexpr double kShortShare = 0.02;
  if (scans.size() < kFewestJudged) return false;
  std::vector<double> ways = ways_of(scans.subspan(1));
  const double long_way = geometry::lower_quantile(ways, 0.9);
  return long_way > 0.0 &&
         share_of(ways, [&](double way) { return way < kShort * long_way; }) >= kShortShare;
}

bool may_count_seconds(std::span<const ScanMark> scans, const WayPace& pace) {
  if (!comes_by_time(scans) || !scans.front().stamp_ns || !scans.back().stamp_ns) return false;
  const double period_s = 1e-9 *
                          static_cast<double>(*scans.back().stamp_ns - *scans.front().stamp_ns) /
                          static_cast<double>(scans.size() - 1);
  return period_s >= 1.0 &&
         geometry::lower_quantile(ways_of(scans.subspan(1)), 0.9) >= pace.speed_mps * period_s;
}

std::vector<std::int64_t> stamps_from_way(std::span<const ScanMark> scans, const WayPace& pace) {
  constexpr double kTopSpeedPerPace = 4.0;
  constexpr double kShortestSteadyPeriodS = 1.0 / 75.0;  // of the planar scanners in use
  constexpr double kLongestSteadyPeriodS = 1.0;
  std::vector<double> periods_s;
  for (const ScanMark& scan : scans)
    periods_s.push_back(
        std::max(scan.way_m / pace.speed_mps, scan.turn_rad / pace.turn_rate_radps));
  if (comes_by_time(scans)) {
    const double period_s = std::clamp(geometry::lower_quantile(periods_s, 0.9) / kTopSpeedPerPace,
                                       kShortestSteadyPeriodS, kLongestSteadyPeriodS);
    return evenly_spaced(scans.size(), period_s);
  }
  std::vector<std::int64_t> stamps_ns;
  double stamp_s = 0.0;
  for (std::size_t i = 0; i < scans.size(); ++i) {
    if (i > 0)
      stamp_s += std::clamp(periods_s[i], pace.least_period_s,
                            std::max(pace.least_period_s, pace.longest_period_s));
    stamps_ns.push_back(std::llround(stamp_s * 1e9));
  }
  return stamps_ns;
}

WayPace pace_among(double median_range_m) {
  constexpr double kSecondsToWhatIsAround = 8.0;
  return {.speed_mps = std::clamp(median_range_m / kSecondsToWhatIsAround, 0.5, 5.0)};
}

}  // namespace slammot::sensing
