#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "common/files/carmen_record.hpp"
#include "common/sensing/stamp_guard.hpp"

namespace slammot::files {

/// Which time becomes the scans' stamp.
enum class LogClock : std::uint8_t {
  kIpc,      ///< ipc_timestamp, as it should be.
  kLogger,   ///< logger_timestamp, where ipc_timestamp stands still, repeats, goes back or only counts scans.
  kNominal,  ///< Neither is a clock: scan after scan at kNominalRateHz from 0 on.
};

/// Where odometry is taken from.
enum class OdometrySource : std::uint8_t {
  kNone,          ///< No pose in the log ever changes.
  kLaserRecords,  ///< The pose in the laser records; ODOM lines contradict it or share no clock with it.
  kOdomLines,     ///< ODOM lines only: the laser records' pose stands still.
  kBoth,          ///< The laser records' pose, and ODOM lines between the scans, which agree with it.
};

/// What a log looks like, for choosing a profile and for the report. Zero where it cannot be told.
struct LogFigures {
  std::uint64_t scans = 0;
  std::uint64_t odom_lines = 0;
  std::size_t beams = 0;               ///< Of most scans.
  bool has_clock = false;              ///< Its own one, not the nominal one.
  double field_of_view_rad = 0.0;      ///< beams * step: 2 pi for a scanner that sees all around.
  double max_range_m = 0.0;
  double median_range_m = 0.0;         ///< Of the echoes.
  double far_range_m = 0.0;            ///< 90 % of the echoes are nearer.
  double scan_period_s = 0.0;          ///< Median.
  double scan_period_spread = 0.0;     ///< (90th - 10th percentile) / median of the period: 0 for a steady scanner.
  double duration_s = 0.0;
  double distance_m = 0.0;             ///< By odometry.
  double cruising_speed_mps = 0.0;     ///< 90th percentile by odometry; 0 without a clock.
};

/// Everything about a log that has to be known before its first scan can be understood.
struct LogPlan {
  LaserRecordKind laser = LaserRecordKind::kFlaser;
  LogClock clock = LogClock::kIpc;
  OdometrySource odometry = OdometrySource::kNone;
  geometry::Pose2 base_from_laser;
  double max_range_m = 0.0;  ///< A reading at or beyond it is "no echo"; a scan's own record may say less.
  bool first_scan_is_ahead = false;  ///< By its stamp: the two after it are far before it, and agree.
  LogFigures figures;
};

inline constexpr double kNominalRateHz = 10.0;

/// Looks at all records of a log once and decides how to read it.
class CarmenSurvey {
 public:
  void add(const CarmenRecord& record);

  /// fallback_field_of_view_rad: of scanners whose records do not say, from the first to the last beam.
  LogPlan conclude(double fallback_field_of_view_rad) const;

 private:
  struct StampedPose {
    std::int64_t stamp_ns = 0;
    geometry::Pose2 wheel_from_base;
  };

  /// Whether stamps advance like a clock.
  class ClockCheck {
   public:
    void add(std::optional<std::int64_t> stamp_ns);
    bool is_usable() const;
    bool begins_ahead() const { return begins_ahead_; }

   private:
    void begin_anew_without_the_first();

    std::vector<std::int64_t> first_ns_;   // three of them
    bool begins_ahead_ = false;
    std::uint64_t scans_ = 0;
    std::uint64_t advancing_ = 0;  // newer than all before
    bool counts_scans_ = true;     // whole numbers one second apart
    sensing::StampGuard guard_{600.0};  // one wrong stamp is the localizer's business
    std::optional<std::int64_t> newest_ns_;
    std::vector<std::int64_t> steps_ns_;
  };

  /// Whether ODOM lines, interpolated, meet the poses of the laser records.
  class AgreementCheck {
   public:
    void add_odom(const StampedPose& odom);
    void add_laser(const StampedPose& laser);
    bool agrees() const;

   private:
    std::optional<StampedPose> before_;
    std::vector<StampedPose> waiting_;
    std::uint64_t compared_ = 0;
    std::uint64_t met_ = 0;
  };

  /// What is kept for each kind of laser record.
  struct Lasers {
    std::uint64_t scans = 0;
    std::map<std::size_t, std::uint64_t> scans_by_beams;
    std::map<double, std::uint64_t> scans_by_recorded_max_range;
    std::optional<BeamLayout> layout;
    std::vector<std::uint32_t> readings_by_cm;       // up to 650 m
    std::vector<float> smallest_reading_by_cm;
    std::vector<StampedPose> poses;                  // by ipc time, 0 where there is none
    std::vector<std::int64_t> logger_ns;
    std::optional<geometry::Pose2> base_from_laser;  // of the first record
    bool base_from_laser_is_constant = true;
    ClockCheck ipc_clock;
    ClockCheck logger_clock;
    AgreementCheck agreement;
    bool pose_changes = false;
  };

  void add_laser(const LaserRecord& record);
  void add_odom(const OdometryRecord& record);
  void add_param(const ParamRecord& record);

  static double max_range_m(const Lasers& lasers);
  OdometrySource odometry_source(const Lasers& lasers, LogClock clock) const;
  geometry::Pose2 base_from_laser(const Lasers& lasers) const;
  LogFigures figures(const Lasers& lasers, const LogPlan& plan, double fallback_field_of_view_rad) const;

  std::array<Lasers, 2> lasers_;  // by LaserRecordKind
  std::uint64_t odom_lines_ = 0;
  std::optional<geometry::Pose2> first_odom_pose_;
  bool odom_pose_changes_ = false;
  std::array<std::optional<double>, 3> laser_offset_params_;  // x, y [m], heading [rad]
};

}  // namespace slammot::files
