#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace slammot::sensing {

/// What is wrong with the stamps of a log's scans.
enum class ClockFault : std::uint8_t {
  kNone,       ///< They advance like a clock.
  kAbsent,     ///< Most scans have none.
  kConstant,   ///< They never change, or a few times only.
  kIndex,      ///< They count scans.
  kUnit,       ///< They are in milliseconds, microseconds or nanoseconds.
  kCoarse,     ///< They are rounded to more than scans are apart.
  kBackwards,  ///< They decrease.
  kJumps,      ///< They jump, and go on from there.
  kErratic,    ///< They advance too seldom, for another reason than those above.
};

/// One scan of a log: its recorded stamp and the way from the scan before it by odometry.
struct ScanMark {
  std::optional<std::int64_t> stamp_ns;
  double way_m = 0.0;
  double turn_rad = 0.0;  ///< Without sign.
};

/// Pace at which time is made from the way where nothing else says it.
struct WayPace {
  double least_period_s = 0.1;
  double longest_period_s = 10.0;
  double speed_mps = 0.5;         ///< Of a vehicle whose log has a scan every so many metres; others drive four times as fast at times.
  double turn_rate_radps = 0.5;
};

/// Stamps to use for a log's scans.
struct ScanTimes {
  ClockFault fault = ClockFault::kNone;
  bool is_clock = true;                 ///< Differences of the stamps are times, though perhaps rounded ones.
  std::vector<std::int64_t> stamps_ns;  ///< One a scan; empty: as recorded.
  double unit_s = 1.0;                  ///< kUnit: of the recorded numbers.
  double quantum_s = 0.0;               ///< kCoarse: what stamps are rounded to.
  std::uint64_t jumps = 0;              ///< kJumps: bridged by the usual period.
};

/// Judges the recorded stamps and repairs them where they still hold a time: other units are converted, a clock that runs
/// backwards is mirrored, coarse stamps are spread within their quantum as evenly as the way or the number of scans
/// allows, jumps that last are bridged. Duplicates and single late or early stamps are kept.
/// is_clock is false where no time is in them; stamps_ns is empty then.
ScanTimes judge_scan_stamps(std::span<const ScanMark> scans);

/// Whether scans come at a steady rate, by their ways: some are far shorter than others, as where a vehicle slows down and
/// stands. Otherwise scans were left out until the vehicle had moved. False where nothing moves.
bool comes_by_time(std::span<const ScanMark> scans);

/// Stamps from 0 on. Scans that come by time have a constant period; others are as far apart as the way takes at the pace.
std::vector<std::int64_t> stamps_from_way(std::span<const ScanMark> scans, const WayPace& pace);

/// Pace of a vehicle among things at this median range: walking pace in rooms, a few metres a second in the open.
WayPace pace_among(double median_range_m);

}  // namespace slammot::sensing
