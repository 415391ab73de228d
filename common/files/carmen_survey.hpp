#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "common/files/carmen_record.hpp"
#include "common/files/log_plan.hpp"
#include "common/files/mounting_params.hpp"
#include "common/files/recorded_odometry.hpp"
#include "common/files/scanner_survey.hpp"
#include "common/files/stray_odometry.hpp"

namespace slammot::files {

/// Surveys all records of a log once and decides how to interpret it.
class CarmenSurvey {
 public:
  void add(const CarmenRecord& record);

  /// fallback_field_of_view_rad: from the first to the last beam, for records without one.
  LogPlan conclude(double fallback_field_of_view_rad, const ScannerWish& wish = {}) const;

  /// All scanners of the log that scan the plane, the main one first.
  std::vector<ScannerPlan> scanners(const ScannerWish& wish = {}) const;
  /// Those that scan a vertical profile.
  std::vector<ScannerPlan> profile_scanners(const ScannerWish& wish = {}) const;
  bool has_scanner(const std::string& name) const;

  /// The clock by which the scans of a steady scanner were logged in another order than they were
  /// taken in (SortedRecords). A few scans that come late are left to localization.
  std::optional<LogClock> clock_of_disordered_scans() const;

  StrayOdometry stray_odometry() const { return stray_odometry_of(scanners_, odometry_lines_); }

 private:
  ScannerSurvey& scanner_of(const LaserRecord& record);
  void add_odometry(const OdometryRecord& record);
  matching::LogEvidence weigh(const ScannerSurvey& scanner, const LogPlan& plan,
                              double fallback_field_of_view_rad) const;
  void take_unit(double unit_m, double fallback_field_of_view_rad,
                 std::vector<ScannerSurvey>& scanners, LogPlan& plan) const;
  OdometryRecordKind odometry_lines() const;
  const OdometryLines& chosen_odometry_lines() const {
    return odometry_lines_[static_cast<std::size_t>(odometry_lines())];
  }

  std::deque<ScannerSurvey> scanners_;
  OdometryLinesByKind odometry_lines_;
  std::optional<sensing::Odometry> newest_odom_;  ///< By ipc time.
  std::optional<sensing::Odometry> newest_odom_by_order_;
  std::int64_t lines_ = 0;
  std::uint64_t imu_lines_ = 0;
  MountingParams params_;
};

}  // namespace slammot::files
