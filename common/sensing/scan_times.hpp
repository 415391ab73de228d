#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "common/sensing/scan_mark.hpp"

namespace slammot::sensing {

/// Defect of the scan stamps of a log.
enum class ClockFault : std::uint8_t {
  kNone,       ///< Regular stamps.
  kAbsent,     ///< Most scans have no stamp.
  kConstant,   ///< Constant, or with only a few changes.
  kIndex,      ///< Scan counters.
  kUnit,       ///< They are in milliseconds, microseconds or nanoseconds.
  kCoarse,     ///< Rounded to more than the scan period.
  kNoisy,      ///< Of a steady scanner, by a computer that was busy.
  kBackwards,  ///< They decrease.
  kJumps,      ///< The clock jumps and continues from there.
  kErratic,    ///< Too few steps advance, for another reason.
};

/// Speed that converts ways to times, for logs without usable stamps.
struct WayPace {
  double least_period_s = 0.1;
  double longest_period_s = 10.0;
  double speed_mps = 0.5;  ///< Of a vehicle that logs a scan at fixed distances; others may drive
                           ///< four times as fast.
  double turn_rate_radps = 0.5;
};

/// Stamps to use for a log's scans.
struct ScanTimes {
  ClockFault fault = ClockFault::kNone;
  bool is_clock = true;  ///< True if differences of the stamps are times, possibly rounded.
  std::vector<std::int64_t> stamps_ns;  ///< One a scan; empty: use the recorded ones.
  double unit_s = 1.0;                  ///< kUnit: unit of the recorded numbers.
  double quantum_s = 0.0;               ///< kCoarse: rounding interval.
  double noise_s = 0.0;                 ///< kNoisy: one sigma.
  std::uint64_t jumps = 0;  ///< kJumps: number of jumps, each replaced by the usual period.
};

/// Classifies the recorded stamps and repairs them if they contain time. Other units are converted;
/// a decreasing clock is mirrored; coarse stamps are spread within their quantum as evenly as the
/// way or the number of scans allows; lasting jumps and the noise of steady_stamps() are removed.
/// Duplicates and single late or early stamps are kept. If the stamps contain no time, is_clock is
/// false and stamps_ns is empty.
ScanTimes judge_scan_stamps(std::span<const ScanMark> scans);

/// True if scans were taken at a constant rate: some ways are far shorter than others, as when a
/// vehicle slows down and stops. Otherwise scans were triggered by motion. False if nothing moves.
bool comes_by_time(std::span<const ScanMark> scans);

/// True if stamps that count scans (ClockFault::kIndex) may be seconds of a clock: scans were taken
/// at a constant rate, and by these seconds the vehicle drives at the pace at least. By the count
/// of a faster scanner it would creep.
bool may_count_seconds(std::span<const ScanMark> scans, const WayPace& pace);

/// Synthetic stamps from 0 on: a constant period for scans at a constant rate, otherwise way
/// divided by pace.
std::vector<std::int64_t> stamps_from_way(std::span<const ScanMark> scans, const WayPace& pace);

/// Assumed pace for this median range: walking pace in rooms, a few metres per second outdoors.
WayPace pace_among(double median_range_m);

}  // namespace slammot::sensing
