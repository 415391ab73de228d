#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "common/files/carmen_record.hpp"
#include "common/files/result.hpp"
#include "common/files/topic_choice.hpp"
#include "common/matching/log_evidence.hpp"
#include "common/sensing/floor_survey.hpp"
#include "common/sensing/own_body.hpp"
#include "common/sensing/scan_times.hpp"
#include "common/sensing/spatial_mounting.hpp"

namespace slammot::files {

/// Clock of the scan stamps.
enum class LogClock : std::uint8_t {
  kIpc,      ///< ipc_timestamp, the usual one.
  kLogger,   ///< logger_timestamp, if ipc_timestamp is constant, repeats, decreases or only counts
             ///< scans.
  kNominal,  ///< Neither is a clock: stamps from 0 on, at kNominalRateHz, or slower for long ways
             ///< between scans.
};

/// Source of odometry.
enum class OdometrySource : std::uint8_t {
  kNone,          ///< All poses in the log are constant.
  kLaserRecords,  ///< Poses of the laser records; ODOM lines contradict them or have another clock.
  kOdomLines,     ///< ODOM lines only: the poses of the laser records are constant.
  kBoth,          ///< Poses of the laser records, and consistent ODOM lines between them.
};

/// Statistics of a log, for the choice of a profile and for the report. Zero if unknown.
struct LogFigures {
  std::uint64_t scans = 0;
  std::uint64_t odom_lines = 0;
  std::uint64_t imu_lines = 0;
  std::size_t beams = 0;           ///< Of most scans.
  bool has_clock = false;          ///< Differences of the stamps, recorded or repaired, are times.
                                   ///< Otherwise speeds are unknown.
  bool comes_by_time = false;      ///< Without a clock: the scan rate is constant but unknown. See
                                   ///< sensing::comes_by_time().
  double field_of_view_rad = 0.0;  ///< beams * step: 2 pi for a full-circle scanner.
  double max_range_m = 0.0;
  double median_range_m = 0.0;  ///< Of the echoes.
  double far_range_m = 0.0;     ///< 90 % of the echoes are nearer.
  double scan_period_s = 0.0;   ///< Median.
  double longest_gap_s = 0.0;   ///< Between two scans.
  bool are_of_scans = false;    ///< Counted in the log's scans; of a scenario only what it says.
  double echo_share = 0.0;      ///< Of all readings.
  std::uint64_t scans_without_readings = 0;  ///< Blank scans: only NaN, infinity or 0.
  double scan_period_spread = 0.0;  ///< (90th - 10th percentile) / median of the period: 0 for a
                                    ///< steady scanner.
  double duration_s = 0.0;
  double distance_m = 0.0;          ///< By odometry.
  double cruising_speed_mps = 0.0;  ///< 90th percentile by odometry; 0 without a clock.
};

/// A scanner of a log.
struct ScannerPlan {
  std::string name;  ///< As in LaserRecord::scanner.
  LaserRecordKind kind = LaserRecordKind::kFlaser;
  std::uint8_t slot = 1;
  std::uint64_t scans = 0;
  geometry::Pose2 base_from_laser;
  double max_range_m = 0.0;          ///< As in LogPlan.
  double refuted_max_range_m = 0.0;  ///< Stated by the log, below many of the readings: ignored.
  sensing::OwnBody own_body;         ///< In recorded units, as readings are written.
  sensing::FloorInView floor;        ///< In recorded units, as readings are written.
  bool mounting_is_known = true;     ///< From the log; otherwise base_from_laser is a guess.
  std::optional<sensing::SpatialMounting> profile_mounting;  ///< Of a scanner that scans a vertical
                                                             ///< profile.
};

/// Selection of a log's scanners.
struct ScannerWish {
  std::string main;               ///< Name of the main scanner; empty: chosen by content.
  std::vector<std::string> used;  ///< Names of the scanners to use, from CarmenSurvey::scanners();
                                  ///< empty: all with known mounting.
  std::vector<VerticalScanner> vertical = {};  ///< As TopicOptions::vertical.
};

/// Their names with commas between them.
std::string enumerated(const std::vector<ScannerPlan>& scanners);

/// Keeps the named scanners, in the order of `scanners`; all if no name is given. For an unknown
/// name, one line with the known ones.
std::optional<Error> select_scanners(const std::vector<std::string>& wanted,
                                     std::vector<ScannerPlan>& scanners);

/// Interpretation of a log, needed before its first scan is read.
struct LogPlan {
  LaserRecordKind laser = LaserRecordKind::kFlaser;  ///< Of the main scanner, to which the
                                                     ///< statistics belong.
  std::vector<ScannerPlan> scanners;  ///< Scanners in use, the main one first. Empty: all records
                                      ///< of kind `laser` are its.
  std::vector<ScannerPlan> profile_scanners;   ///< Scanners of vertical profiles: neither localized
                                               ///< nor mapped; for the city model.
  std::vector<std::string> unplaced_scanners;  ///< Unused scanners with unknown mounting.
  LogClock clock = LogClock::kIpc;
  matching::LogEvidence evidence;  ///< Corrections of poses and beams.
  sensing::ScanTimes times;  ///< Defect of the clock, and stamps that replace the recorded ones.
  std::vector<std::uint32_t> odom_lines_before_scan;  ///< One a scan, since the scan before: gives
                                                      ///< ODOM lines a time if stamps are replaced.
  OdometrySource odometry = OdometrySource::kNone;
  OdometrySource recorded_odometry = OdometrySource::kNone;  ///< The same whether it is of use or
                                                             ///< not.
  OdometryRecordKind odometry_lines = OdometryRecordKind::kOdom;  ///< Which lines count as ODOM.
  std::size_t odometry_held_scans = 0;  ///< Odometry comes less often than scans, which repeat its
                                        ///< last pose, at most for so many scans while the vehicle
                                        ///< moves: between them it is interpolated. 0: with each.
  std::size_t odometry_smoothed_over = 0;  ///< Odometry is noisy from one to the next: each is
                                           ///< smoothed over so many on either side. 0: as it is.
  bool odometry_is_too_noisy = false;      ///< Therefore it is not used,
  bool odometry_is_too_rare = false;       ///< or therefore.
  double odometry_late_s = 0.0;  ///< Lateness of its stamps against the scans; removed on reading.
                                 ///< Where the clocks drift apart, at odometry_late_at_ns.
  double odometry_drift = 0.0;   ///< Growth of the lateness with time, seconds a second.
  std::int64_t odometry_late_at_ns = 0;
  std::vector<std::int64_t> odometry_stamps_ns;  ///< Of ODOM lines, without the noise of the
                                                 ///< recorded ones. Empty: the recorded ones.
  double odometry_stamp_noise_s = 0.0;           ///< One sigma of it.
  geometry::Pose2 base_from_laser;
  double max_range_m = 0.0;  ///< Readings at or beyond it are "no echo"; a scan's own record may
                             ///< have a lower limit.
  std::size_t stray_odometry = 0;    ///< Poses of odometry that are none of the drive's, left out.
  std::uint64_t repeated_scans = 0;  ///< Recorded again with stamp and readings: left out.
  bool scans_are_sorted = false;     ///< They were logged in another order.
  bool first_scan_is_ahead = false;  ///< The next two scans have consistent stamps far before the
                                     ///< first one's.
  LogFigures figures;

  /// True if scans have other stamps than recorded, which have nothing to do with those of other
  /// records: these count by their order. Stamps without noise are of the same clock.
  bool is_timed_by_order() const {
    return !times.stamps_ns.empty() && times.fault != sensing::ClockFault::kNoisy;
  }

  bool odometry_is_late() const { return odometry_late_s != 0.0 || odometry_drift != 0.0; }
  /// Of odometry with this stamp.
  std::int64_t odometry_lateness_ns(std::int64_t stamp_ns) const;
};

inline constexpr double kNominalRateHz = 10.0;

}  // namespace slammot::files
