#include "common/files/odometry_plan.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "common/files/log_profile.hpp"
#include "common/files/scan_clock.hpp"
#include "common/matching/odometry_timing.hpp"
#include "common/sensing/steady_stamps.hpp"

namespace slammot::files {
namespace {

/// Without those that are older than one before.
std::vector<sensing::Odometry> odometry_of_scans(const ScannerSurvey& scanner,
                                                 const LogPlan& plan) {
  const std::vector<std::int64_t> stamps_ns = scan_stamps_of(scanner, plan);
  std::vector<sensing::Odometry> odometry;
  for (std::size_t i = 0; i < stamps_ns.size(); ++i) {
    const bool is_held =
        plan.odometry_held_scans > 0 && i > 0 && scanner.poses.all[i] == scanner.poses.all[i - 1];
    const bool is_late = !odometry.empty() && stamps_ns[i] <= odometry.back().stamp_ns;
    if (!is_held && !is_late) odometry.push_back({stamps_ns[i], scanner.poses.all[i]});
  }
  return odometry;
}

/// The same of ODOM lines.
std::vector<sensing::Odometry> odometry_of_lines(const OdometryLines& lines, const LogPlan& plan) {
  const auto& recorded_ns = lines.stamps.of(plan.clock);
  std::vector<sensing::Odometry> odometry;
  for (std::size_t i = 0; i < lines.count(); ++i) {
    const auto stamp_ns = plan.odometry_stamps_ns.empty()
                              ? recorded_ns[i]
                              : std::optional(plan.odometry_stamps_ns[i]);
    if (stamp_ns && (odometry.empty() || *stamp_ns > odometry.back().stamp_ns))
      odometry.push_back({*stamp_ns, lines.poses.all[i]});
  }
  return odometry;
}

/// With the stamps of the plan.
std::vector<sensing::Odometry> stamped_odometry_of(const ScannerSurvey& scanner,
                                                   const OdometryLines& lines,
                                                   const LogPlan& plan) {
  return plan.odometry == OdometrySource::kOdomLines ? odometry_of_lines(lines, plan)
                                                     : odometry_of_scans(scanner, plan);
}

/// scan_times_s: of the middle of the sweep where that is known. Otherwise odometry of a scanner
/// that sweeps seems late by half of the sweep: the scan is stamped at its first beam.
matching::OdometryDrift fine_odometry_lateness(const ScannerSurvey& scanner, const LogPlan& plan,
                                               double fallback_field_of_view_rad,
                                               std::span<const double> scan_times_s,
                                               std::span<const matching::TimedPose> of_base,
                                               double roughly_s) {
  constexpr double kLeast_s = 0.012;  // less is estimated during the drive
  constexpr double kSigmas = 5.0;
  constexpr double kMostSigma_s = 0.01;   // noise of wheels on an even drive looks like 0.02
  constexpr double kSlowestTurn_s = 0.2;  // of a scanner
  constexpr double kDense_s = 0.06;       // time between samples, in which a car turns evenly
  const matching::LogCorrection& correction = plan.evidence.correction;
  const matching::OdometryDrift rough{roughly_s, 0.0, 0.0};
  const bool is_as_stated = correction.way_unit_m == 1.0 && correction.heading_unit_rad == 1.0 &&
                            !correction.reverses_beams && correction.field_factor == 1.0;
  const bool is_dense = of_base.size() > 1 && of_base.back().time_s - of_base.front().time_s <
                                                  kDense_s * static_cast<double>(of_base.size());
  if (!is_as_stated || !is_dense || scan_times_s.size() < 2) return rough;
  const std::vector<matching::ScanPair> pairs =
      with_echoes_of_others(scanner.pairs.timing_pairs(), plan);
  if (pairs.empty()) return rough;
  const std::size_t beam_count = pairs.front().first.size();
  const matching::AssumedBeams beams =
      assumed_beams_of(scanner, plan, beam_count, fallback_field_of_view_rad);
  const double swept_rad = std::abs(beams.beam_step_rad) * static_cast<double>(beam_count);
  const double period_s =
      (scan_times_s.back() - scan_times_s.front()) / static_cast<double>(scan_times_s.size());
  const double half_sweep_s =
      sweep_s_by_period(plan.figures) > 0.0
          ? 0.0
          : 0.5 * swept_rad / (2.0 * std::numbers::pi) * std::min(period_s, kSlowestTurn_s);
  const matching::LogToTime log{pairs,        beams,   correction.range_unit_m,
                                scan_times_s, of_base, roughly_s};
  const matching::MotionsByScans motions = matching::motions_by_scans(log);
  if (auto drifting = matching::odometry_drift(motions, log)) {
    drifting->late_s -= 0.5 * half_sweep_s;  // swept or not
    return *drifting;
  }
  const auto found = matching::odometry_timing(motions, log);
  if (!found || found->sigma_s > kMostSigma_s) return rough;
  const double late_s = found->late_s - 0.5 * half_sweep_s;
  const double least_s = 0.5 * half_sweep_s + std::max(kLeast_s, kSigmas * found->sigma_s);
  const bool is_used = roughly_s != 0.0 || std::abs(late_s) > least_s;
  return {is_used ? late_s : 0.0, 0.0, 0.0};
}

/// Finds the lateness of odometry that has the clock of the scans.
void remove_lateness(const ScannerSurvey& scanner, std::span<const sensing::Odometry> recorded,
                     double fallback_field_of_view_rad, LogPlan& plan) {
  const bool has_clock =
      plan.clock != LogClock::kNominal && !plan.is_timed_by_order() && !plan.first_scan_is_ahead;
  if (!has_clock) return;
  const std::vector<std::int64_t> stamps_ns = scan_stamps_of(scanner, plan);
  if (stamps_ns.empty()) return;
  const auto time_s = [&](std::int64_t stamp_ns) {
    return static_cast<double>(stamp_ns - stamps_ns.front()) * 1e-9;
  };
  const matching::LogCorrection& correction = plan.evidence.correction;
  std::vector<double> scan_times_s;
  const double half_sweep_s = 0.5 * sweep_s_by_period(plan.figures);
  for (const std::int64_t stamp_ns : stamps_ns)
    scan_times_s.push_back(time_s(stamp_ns) + half_sweep_s);
  std::vector<matching::TimedPose> odometry;
  std::vector<matching::TimedPose> of_base;
  matching::PoseCorrection in_order;
  for (const auto& [stamp_ns, wheel_from_base] : recorded) {
    odometry.push_back({time_s(stamp_ns), corrected(correction, wheel_from_base)});
    of_base.push_back({time_s(stamp_ns), in_order.next(correction, wheel_from_base)});
  }
  const double roughly_s =
      matching::odometry_lateness_s(plan.evidence.motions, scan_times_s, odometry,
                                    {plan.evidence.way_scale, plan.evidence.turn_scale});
  const matching::OdometryDrift found = fine_odometry_lateness(
      scanner, plan, fallback_field_of_view_rad, scan_times_s, of_base, roughly_s);
  plan.odometry_late_s = found.late_s;
  plan.odometry_drift = found.drift;
  plan.odometry_late_at_ns = stamps_ns.front() + std::llround(1e9 * found.at_s);
}

/// Noisy odometry looks like slip, and between samples that come seldom a car brakes and turns.
/// What smoothing and interpolation leave of that is correlated from scan to scan, and worse than
/// no odometry where scans come so often that they suffice.
void treat_poor_odometry(const ScannerSurvey& scanner, const OdometryLines& lines,
                         std::span<const sensing::Odometry> odometry, LogPlan& plan) {
  constexpr double kFrequentScans_s = 0.04;
  constexpr double kLongestPeriod_s = 0.1;
  constexpr double kWindow_s = 0.5;
  constexpr double kNoise_m = 1.5e-3;  // wheels are below 0.3 mm
  constexpr double kMuchNoise_m = 8e-3;
  constexpr double kTurned_m = 1.0;  // how far ahead what turns counts as moved aside
  constexpr double kRare_s = 0.5;    // twice what nine of ten samples come after
  const matching::LogCorrection& correction = plan.evidence.correction;
  const bool is_in_units = correction.way_unit_m == 1.0 && correction.heading_unit_rad == 1.0 &&
                           !correction.mirrors_position && !correction.mirrors_heading;
  if (!plan.figures.has_clock || !is_in_units) return;
  const bool is_in_lines = plan.odometry == OdometrySource::kOdomLines;
  const double scan_period_s = plan.figures.scan_period_s;
  const double period_s =
      is_in_lines ? plan.figures.duration_s / static_cast<double>(lines.count()) : scan_period_s;
  const double along_m = sensing::forward_noise_m(odometry);
  const double turned_m = kTurned_m * sensing::turn_noise_rad(odometry);
  const double of_motion_m = std::max(along_m, turned_m);
  const double noise_m = std::max((is_in_lines ? lines.poses : scanner.poses).noise.mean_m(),
                                  of_motion_m > kMuchNoise_m ? of_motion_m : 0.0);
  const double held_s = static_cast<double>(plan.odometry_held_scans) * scan_period_s;
  const bool is_held = plan.odometry_held_scans > 0 && !is_in_lines;
  const bool is_noisy =
      !is_held && period_s > 0.0 && period_s <= kLongestPeriod_s && noise_m > kNoise_m;
  const bool scans_suffice = scan_period_s <= kFrequentScans_s;
  plan.odometry_is_too_noisy = scans_suffice && is_noisy && noise_m > kMuchNoise_m;
  plan.odometry_is_too_rare = scans_suffice && is_held && held_s > kRare_s;
  if (plan.odometry_is_too_noisy || plan.odometry_is_too_rare) {
    plan.odometry = OdometrySource::kNone;
    plan.odometry_late_s = 0.0;
    plan.odometry_drift = 0.0;
    plan.odometry_held_scans = 0;
    plan.odometry_stamps_ns.clear();
    plan.odometry_stamp_noise_s = 0.0;
  } else if (is_noisy) {
    plan.odometry_smoothed_over = static_cast<std::size_t>(std::ceil(0.5 * kWindow_s / period_s));
    if (plan.odometry == OdometrySource::kBoth) plan.odometry = OdometrySource::kLaserRecords;
  }
}

void remove_noise_of_odometry_stamps(const OdometryLines& lines, LogPlan& plan) {
  const bool uses_lines =
      plan.odometry == OdometrySource::kOdomLines || plan.odometry == OdometrySource::kBoth;
  if (!uses_lines || plan.clock == LogClock::kNominal || plan.is_timed_by_order()) return;
  std::vector<std::int64_t> stamps_ns;
  for (const auto& stamp_ns : lines.stamps.of(plan.clock)) {
    if (!stamp_ns) return;
    stamps_ns.push_back(*stamp_ns);
  }
  std::optional<sensing::SteadyStamps> steady = sensing::steady_stamps(stamps_ns);
  if (!steady) return;
  plan.odometry_stamps_ns = std::move(steady->stamps_ns);
  plan.odometry_stamp_noise_s = steady->noise_s;
}

OdometrySource odometry_source_of(const ScannerSurvey& scanner, const OdometryLines& lines,
                                  const LogPlan& plan) {
  if (!scanner.poses.change)
    return lines.poses.change ? OdometrySource::kOdomLines : OdometrySource::kNone;
  if (lines.poses.change && plan.odometry_held_scans > 0) return OdometrySource::kOdomLines;
  const bool agrees = plan.is_timed_by_order()
                          ? scanner.agreement_by_order.agrees()
                          : plan.clock == LogClock::kIpc && scanner.agreement.agrees();
  if (!lines.poses.change || !agrees) return OdometrySource::kLaserRecords;
  // Poses that were interpolated at noisy stamps have their noise; those of the lines do not.
  return plan.times.fault == sensing::ClockFault::kNoisy ? OdometrySource::kOdomLines
                                                         : OdometrySource::kBoth;
}

}  // namespace

void plan_odometry(const ScannerSurvey& scanner, const OdometryLines& lines,
                   double fallback_field_of_view_rad, LogPlan& plan) {
  plan.odometry_held_scans = scanner.held_poses.most_scans();
  plan.odometry = plan.recorded_odometry = odometry_source_of(scanner, lines, plan);
  if (plan.odometry == OdometrySource::kNone) return;
  remove_noise_of_odometry_stamps(lines, plan);
  const std::vector<sensing::Odometry> odometry = stamped_odometry_of(scanner, lines, plan);
  remove_lateness(scanner, odometry, fallback_field_of_view_rad, plan);
  treat_poor_odometry(scanner, lines, odometry, plan);
}

}  // namespace slammot::files
