#include "common/files/scan_clock.hpp"

#include <array>
#include <cmath>
#include <utility>

#include "common/files/pose_difference.hpp"
#include "common/sensing/steady_stamps.hpp"

namespace slammot::files {

std::vector<sensing::ScanMark> scan_marks_of(const ScannerSurvey& scanner, const LogPlan& plan,
                                             LogClock clock) {
  std::vector<sensing::ScanMark> marks(scanner.scans);
  const std::vector<geometry::Pose2>& poses =
      scanner.poses.change
          ? scanner.poses.all
          : scanner.lines_between[static_cast<std::size_t>(plan.odometry_lines)].pose_before_scan;
  const auto pose = [&](std::size_t i) { return corrected(plan.evidence.correction, poses[i]); };
  for (std::size_t i = 0; i < marks.size(); ++i) {
    if (clock != LogClock::kNominal) marks[i].stamp_ns = scanner.stamps.of(clock)[i];
    if (i == 0) continue;
    marks[i].way_m = distance_m(pose(i - 1), pose(i));
    marks[i].turn_rad =
        std::abs(geometry::wrap_angle(pose(i).heading_rad - pose(i - 1).heading_rad));
  }
  return marks;
}

void choose_clock(const ScannerSurvey& scanner, LogPlan& plan) {
  plan.clock = LogClock::kNominal;
  if (scanner.scans == 0) return;
  const std::array clocks{LogClock::kIpc, LogClock::kLogger};
  std::array<sensing::ScanTimes, 2> times;
  const sensing::WayPace pace =
      sensing::pace_among(scanner.readings.range_quantile_m(plan.max_range_m, 0.5));
  for (std::size_t i = 0; i < clocks.size(); ++i) {
    const auto marks = scan_marks_of(scanner, plan, clocks[i]);
    times[i] = sensing::judge_scan_stamps(marks);
    if (times[i].fault == sensing::ClockFault::kIndex && sensing::may_count_seconds(marks, pace))
      times[i] = {};
  }
  const auto take = [&](std::size_t i) {
    plan.clock = clocks[i];
    plan.times = std::move(times[i]);
  };
  const std::array<const ClockCheck*, 2> checks{&scanner.ipc_clock, &scanner.logger_clock};
  for (std::size_t i = 0; i < clocks.size(); ++i) {
    const bool begins_ahead = checks[i]->is_usable() && checks[i]->begins_ahead();
    const bool is_sound = times[i].fault == sensing::ClockFault::kNone ||
                          times[i].fault == sensing::ClockFault::kNoisy;
    if (!begins_ahead && !is_sound) continue;
    take(i);
    if (begins_ahead) plan.times = {};
    plan.first_scan_is_ahead = begins_ahead;
    return;
  }
  for (std::size_t i = 0; i < clocks.size(); ++i) {
    if (times[i].is_clock) return take(i);
  }
  plan.times = std::move(times[times[0].fault == sensing::ClockFault::kAbsent ? 1 : 0]);
  plan.times.stamps_ns =
      sensing::stamps_from_way(scan_marks_of(scanner, plan, LogClock::kNominal), pace);
}

std::vector<std::int64_t> scan_stamps_of(const ScannerSurvey& scanner, const LogPlan& plan) {
  if (!plan.times.stamps_ns.empty()) return plan.times.stamps_ns;
  std::vector<std::int64_t> stamps_ns;
  for (const auto& stamp_ns : scanner.stamps.of(plan.clock)) {
    if (!stamp_ns) return {};
    stamps_ns.push_back(*stamp_ns);
  }
  return stamps_ns;
}

std::optional<LogClock> clock_of_disordered_scans(const std::deque<ScannerSurvey>& scanners) {
  constexpr double kFewLate = 0.02;
  for (const ScannerSurvey& scanner : scanners) {
    for (const LogClock clock : {LogClock::kIpc, LogClock::kLogger}) {
      std::vector<std::int64_t> stamps_ns;
      std::size_t late = 0;
      for (const auto& stamp_ns : scanner.stamps.of(clock)) {
        if (!stamp_ns) continue;
        late += !stamps_ns.empty() && *stamp_ns < stamps_ns.back() ? 1 : 0;
        stamps_ns.push_back(*stamp_ns);
      }
      if (static_cast<double>(late) > kFewLate * static_cast<double>(stamps_ns.size()) &&
          sensing::are_regular_in_another_order(stamps_ns))
        return clock;
    }
  }
  return std::nullopt;
}

}  // namespace slammot::files
