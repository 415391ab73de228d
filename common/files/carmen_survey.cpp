#include "common/files/carmen_survey.hpp"

#include <algorithm>
#include <utility>
#include <variant>

#include "common/files/log_figures.hpp"
#include "common/files/odometry_plan.hpp"
#include "common/files/scan_clock.hpp"
#include "common/files/scanner_choice.hpp"

namespace slammot::files {

void CarmenSurvey::add(const CarmenRecord& record) {
  ++lines_;
  if (const auto* laser = std::get_if<LaserRecord>(&record))
    scanner_of(*laser).add(*laser, lines_, odometry_lines_, odometry_lines());
  if (const auto* odometry = std::get_if<OdometryRecord>(&record)) add_odometry(*odometry);
  if (const auto* param = std::get_if<ParamRecord>(&record)) params_.add(*param);
  if (std::holds_alternative<ImuRecord>(record)) ++imu_lines_;
}

ScannerSurvey& CarmenSurvey::scanner_of(const LaserRecord& record) {
  const auto known = std::ranges::find_if(scanners_, [&](const ScannerSurvey& scanner) {
    return scanner.kind == record.kind && scanner.slot == record.slot;
  });
  if (known != scanners_.end()) return *known;
  ScannerSurvey& scanner = scanners_.emplace_back();
  scanner.kind = record.kind;
  scanner.slot = record.slot;
  scanner.scanner = record.scanner;
  if (newest_odom_) scanner.agreement.add_odom(*newest_odom_);
  if (newest_odom_by_order_) scanner.agreement_by_order.add_odom(*newest_odom_by_order_);
  for (std::size_t kind = 0; kind < odometry_lines_.size(); ++kind)
    scanner.lines_between[kind].since_scan =
        static_cast<std::uint32_t>(odometry_lines_[kind].count());
  return scanner;
}

void CarmenSurvey::add_odometry(const OdometryRecord& record) {
  const auto kind = static_cast<std::size_t>(record.kind);
  odometry_lines_[kind].poses.add(record.wheel_from_base);
  odometry_lines_[kind].stamps.add(record.stamps);
  for (ScannerSurvey& scanner : scanners_) ++scanner.lines_between[kind].since_scan;
  if (record.kind == odometry_lines()) {
    newest_odom_by_order_ = {lines_, record.wheel_from_base};
    for (ScannerSurvey& scanner : scanners_)
      scanner.agreement_by_order.add_odom(*newest_odom_by_order_);
  }
  if (!record.stamps.ipc_ns || record.kind != OdometryRecordKind::kOdom) return;
  newest_odom_ = {*record.stamps.ipc_ns, record.wheel_from_base};
  for (ScannerSurvey& scanner : scanners_) scanner.agreement.add_odom(*newest_odom_);
}

/// TRUEPOS is used only if the log has no other odometry.
OdometryRecordKind CarmenSurvey::odometry_lines() const {
  return odometry_lines_[0].count() == 0 && odometry_lines_[1].count() > 0
             ? OdometryRecordKind::kTruePos
             : OdometryRecordKind::kOdom;
}

bool CarmenSurvey::has_scanner(const std::string& name) const {
  return std::ranges::find(scanners_, name, &ScannerSurvey::scanner) != scanners_.end();
}

std::vector<ScannerPlan> CarmenSurvey::scanners(const ScannerWish& wish) const {
  std::vector<ScannerPlan> plans;
  for (const ScannerSurvey* scanner : ScannerChoice(scanners_, params_, wish).planar())
    plans.push_back(scanner_plan_of(*scanner, params_));
  return plans;
}

std::vector<ScannerPlan> CarmenSurvey::profile_scanners(const ScannerWish& wish) const {
  return ScannerChoice(scanners_, params_, wish).profile_plans();
}

std::optional<LogClock> CarmenSurvey::clock_of_disordered_scans() const {
  return files::clock_of_disordered_scans(scanners_);
}

LogPlan CarmenSurvey::conclude(double fallback_field_of_view_rad, const ScannerWish& wish) const {
  LogPlan plan;
  const ScannerChoice choice(scanners_, params_, wish);
  const std::vector<const ScannerSurvey*> used = choice.used();
  for (const ScannerSurvey* scanner : choice.planar()) {
    const bool is_used = std::ranges::find(used, scanner) != used.end();
    if (!is_used && wish.used.empty()) plan.unplaced_scanners.push_back(scanner->scanner);
  }
  std::vector<ScannerSurvey> scanners;  // in metres
  scanners.reserve(used.size());
  for (const ScannerSurvey* scanner : used) scanners.push_back(*scanner);
  if (scanners.empty()) scanners.emplace_back();
  const ScannerSurvey& main = scanners.front();
  const matching::LogCorrection& correction = plan.evidence.correction;
  plan.laser = main.kind;
  plan.odometry_lines = odometry_lines();
  const double unit_m = matching::range_unit_of(main.readings.recorded_quantile(0.5),
                                                main.readings.recorded_quantile(0.9));
  take_unit(unit_m, fallback_field_of_view_rad, scanners, plan);
  plan.base_from_laser = plan.scanners.front().base_from_laser;
  plan.evidence = weigh(main, plan, fallback_field_of_view_rad);
  if (correction.range_unit_m != unit_m || correction.field_factor != 1.0)
    take_unit(correction.range_unit_m, fallback_field_of_view_rad, scanners, plan);
  if (correction.laser_turn_rad != 0.0)
    plan.base_from_laser.heading_rad =
        geometry::wrap_angle(plan.base_from_laser.heading_rad + correction.laser_turn_rad);
  choose_clock(main, plan);
  plan.figures = log_figures_of(main, plan, fallback_field_of_view_rad);
  plan.figures.odom_lines = odometry_lines_[0].count();
  plan.figures.imu_lines = imu_lines_;
  plan_odometry(main, chosen_odometry_lines(), fallback_field_of_view_rad, plan);
  if (plan.is_timed_by_order())
    plan.odom_lines_before_scan =
        main.lines_between[static_cast<std::size_t>(plan.odometry_lines)].before_scan;
  plan.scanners.front().base_from_laser = plan.base_from_laser;
  if (used.empty()) plan.scanners.clear();
  else plan.profile_scanners = choice.profile_plans();
  return plan;
}

/// Readings are of this unit: how far they reach, and what of the vehicle and the floor is in view.
void CarmenSurvey::take_unit(double unit_m, double fallback_field_of_view_rad,
                             std::vector<ScannerSurvey>& scanners, LogPlan& plan) const {
  plan.evidence.correction.range_unit_m = unit_m;
  plan.scanners.clear();
  for (ScannerSurvey& scanner : scanners) {
    if (unit_m != 1.0) scanner.readings.recount(unit_m);
    ScannerPlan& planned = plan.scanners.emplace_back(scanner_plan_of(scanner, params_));
    planned.own_body = scanner.own_body.conclude(unit_m);
    planned.floor = scanner.floor.conclude(
        surveyed_beams_of(scanner, planned, plan.evidence.correction, fallback_field_of_view_rad));
  }
  plan.max_range_m = plan.scanners.front().max_range_m;
}

/// Matches the sampled pairs, without no-echo readings. Odometry is judged by ODOM lines if there
/// are any, because scan intervals hide the arcs of single steps. Without odometry nothing
/// contradicts the stated layout.
matching::LogEvidence CarmenSurvey::weigh(const ScannerSurvey& scanner, const LogPlan& plan,
                                          double fallback_field_of_view_rad) const {
  const std::vector<matching::ScanPair> pairs = with_echoes_of_others(scanner.pairs.pairs(), plan);
  if (pairs.empty()) return plan.evidence;
  const RecordedPoses& lines = chosen_odometry_lines().poses;
  return matching::weigh_log(
      pairs,
      assumed_beams_of(scanner, plan, pairs.front().first.size(), fallback_field_of_view_rad),
      (lines.change ? lines : scanner.poses).check, plan.evidence.correction.range_unit_m);
}

}  // namespace slammot::files
