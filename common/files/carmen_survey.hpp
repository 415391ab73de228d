#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "common/files/carmen_record.hpp"
#include "common/files/result.hpp"
#include "common/matching/log_evidence.hpp"
#include "common/sensing/scan_times.hpp"
#include "common/sensing/stamp_guard.hpp"

namespace slammot::files {

/// Which time becomes the scans' stamp.
enum class LogClock : std::uint8_t {
  kIpc,      ///< ipc_timestamp, as it should be.
  kLogger,   ///< logger_timestamp, where ipc_timestamp stands still, repeats, goes back or only counts scans.
  kNominal,  ///< Neither is a clock: from 0 on, at kNominalRateHz or slower where the way between scans is long.
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
  std::uint64_t imu_lines = 0;
  std::size_t beams = 0;               ///< Of most scans.
  bool has_clock = false;              ///< Differences of its stamps, as recorded or repaired, are times. Otherwise no speed is known.
  bool comes_by_time = false;          ///< Without a clock: the scanner's rate is steady, though not known. See sensing::comes_by_time().
  double field_of_view_rad = 0.0;      ///< beams * step: 2 pi for a scanner that sees all around.
  double max_range_m = 0.0;
  double median_range_m = 0.0;         ///< Of the echoes.
  double far_range_m = 0.0;            ///< 90 % of the echoes are nearer.
  double scan_period_s = 0.0;          ///< Median.
  double longest_gap_s = 0.0;          ///< Between two scans.
  double echo_share = 0.0;             ///< Of all readings.
  std::uint64_t scans_without_readings = 0;  ///< Nothing but NaN, infinity or 0.
  double scan_period_spread = 0.0;     ///< (90th - 10th percentile) / median of the period: 0 for a steady scanner.
  double duration_s = 0.0;
  double distance_m = 0.0;             ///< By odometry.
  double cruising_speed_mps = 0.0;     ///< 90th percentile by odometry; 0 without a clock.
};

/// One of the scanners that a log has.
struct ScannerPlan {
  std::string name;                      ///< As in LaserRecord::scanner.
  LaserRecordKind kind = LaserRecordKind::kFlaser;
  std::uint8_t slot = 1;
  std::uint64_t scans = 0;
  geometry::Pose2 base_from_laser;
  double max_range_m = 0.0;              ///< As in LogPlan.
  bool mounting_is_known = true;         ///< By the log; otherwise base_from_laser is a guess.
};

/// Which of a log's scanners to use.
struct ScannerWish {
  std::string main;                ///< Name of the main one; empty: by what they hold.
  std::vector<std::string> used;   ///< Names of those to be used, which must be among CarmenSurvey::scanners(); empty: all whose mounting is known.
};

/// Leaves the named scanners, in the order of `scanners`; all where no name is given. Otherwise one line that names those there are.
std::optional<Error> select_scanners(const std::vector<std::string>& wanted, std::vector<ScannerPlan>& scanners);

/// Everything about a log that has to be known before its first scan can be understood.
struct LogPlan {
  LaserRecordKind laser = LaserRecordKind::kFlaser;  ///< Of the main scanner, which the figures are of.
  std::vector<ScannerPlan> scanners;                 ///< Those to be used, the main one first. Empty: every record of the kind `laser` is the main one's.
  std::vector<std::string> unplaced_scanners;         ///< Not used, for the log does not say where they are mounted.
  LogClock clock = LogClock::kIpc;
  matching::LogEvidence evidence;                     ///< How poses and beams are to be understood.
  sensing::ScanTimes times;                           ///< What is wrong with that clock; stamps that replace the recorded ones.
  std::vector<std::uint32_t> odom_lines_before_scan;  ///< One a scan, since the scan before it: places ODOM lines in time where stamps are replaced.
  OdometrySource odometry = OdometrySource::kNone;
  OdometryRecordKind odometry_lines = OdometryRecordKind::kOdom;  ///< Which lines count as ODOM.
  double odometry_late_s = 0.0;     ///< By so much its stamps lag behind those of the scans; taken back on reading.
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
  LogPlan conclude(double fallback_field_of_view_rad, const ScannerWish& wish = {}) const;

  /// All that the log has, the main one first.
  std::vector<ScannerPlan> scanners(const std::string& main_scanner = {}) const;
  bool has_scanner(const std::string& name) const;

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

  /// Pairs of scans with a little motion between, evenly over the log, few enough to be matched at once.
  class PairSample {
   public:
    /// A pair ends where the vehicle has moved or turned by so much, and is left out where it moved by more than the most.
    PairSample(double moved_m, double turned_rad, double most_m) : moved_m_(moved_m), turned_rad_(turned_rad), most_m_(most_m) {}

    /// scan: counted from 0.
    void add(const std::vector<float>& ranges, const geometry::Pose2& recorded, std::size_t scan);
    const std::vector<matching::ScanPair>& pairs() const { return pairs_; }

   private:
    static constexpr std::size_t kMost = 48;
    double moved_m_;
    double turned_rad_;
    double most_m_;
    std::vector<matching::ScanPair> pairs_;
    std::optional<std::pair<std::vector<float>, geometry::Pose2>> anchor_;
    std::size_t anchor_scan_ = 0;
    std::size_t scans_since_anchor_ = 0;
    std::size_t every_ = 1;
    std::size_t offered_ = 0;
  };

  /// What is kept for each kind of laser record of each scanner.
  struct Lasers {
    LaserRecordKind kind = LaserRecordKind::kFlaser;
    std::uint8_t slot = 1;
    std::string scanner;
    std::uint64_t scans = 0;
    std::map<std::size_t, std::uint64_t> scans_by_beams;
    std::map<double, std::uint64_t> scans_by_recorded_max_range;
    std::optional<BeamLayout> layout;
    std::vector<std::uint32_t> readings_by_cm;       // up to 650 m
    std::vector<float> smallest_reading_by_cm;
    std::vector<StampedPose> poses;                  // by ipc time, 0 where there is none
    std::vector<std::optional<std::int64_t>> ipc_ns;
    std::vector<std::optional<std::int64_t>> logger_ns;
    /// What comes between the scans of lines of one OdometryRecordKind.
    struct LinesBetween {
      std::uint32_t since_scan = 0;
      std::vector<std::uint32_t> before_scan;        // how many, by scan
      std::vector<geometry::Pose2> pose_before_scan;
    };
    std::array<LinesBetween, 2> lines_between;       // by OdometryRecordKind
    std::optional<geometry::Pose2> base_from_laser;  // of the first record
    bool base_from_laser_is_constant = true;
    ClockCheck ipc_clock;
    ClockCheck logger_clock;
    AgreementCheck agreement;           // by ipc time
    AgreementCheck agreement_by_order;  // by the lines' order in the log
    bool pose_changes = false;
    std::uint64_t readings = 0;
    std::uint64_t scans_without_readings = 0;
    std::vector<std::uint32_t> readings_by_unit;     // as written, whatever the unit
    matching::OdometryCheck odometry_check;
    PairSample moved_pairs{0.25, 0.12, std::numeric_limits<double>::infinity()};  // whatever the unit
    PairSample pairs_in_small_units{250.0, 0.12, std::numeric_limits<double>::infinity()};  // of odometry in millimetres
    PairSample turned_pairs{1.2, 0.05, 1.2};  // of a vehicle that seldom turns
  };

  void add_laser(const LaserRecord& record);
  void add_odom(const OdometryRecord& record);
  void add_param(const ParamRecord& record);

  /// What PARAM lines say of one scanner.
  struct LaserParams {
    std::array<std::optional<double>, 3> offset;  // x, y [m], heading [rad]
    std::optional<double> max_range_m;

    bool tell_mounting() const { return offset[0] || offset[1] || offset[2]; }
  };

  /// What is known of ODOM lines, and of TRUEPOS lines in their place.
  struct OdometryLines {
    std::uint64_t count = 0;
    std::optional<geometry::Pose2> first_pose;
    geometry::Pose2 last_pose;
    bool pose_changes = false;
    matching::OdometryCheck check;
  };

  Lasers& lasers_of(const LaserRecord& record);
  std::vector<const Lasers*> best_of_each_slot(const std::string& main_scanner) const;
  std::vector<const Lasers*> lasers_to_use(const ScannerWish& wish) const;
  const LaserParams& params_of(const Lasers& lasers) const;
  bool mounting_is_known(const Lasers& lasers) const;
  ScannerPlan scanner_plan(const Lasers& lasers) const;
  double max_range_m(const Lasers& lasers) const;
  static void convert_readings(Lasers& lasers, double unit_m);
  double odometry_lateness_s(const Lasers& lasers, const LogPlan& plan) const;
  matching::LogEvidence weigh(const Lasers& lasers, const LogPlan& plan, double fallback_field_of_view_rad) const;
  std::vector<sensing::ScanMark> scan_marks(const Lasers& lasers, const matching::LogCorrection& correction, LogClock clock) const;
  void choose_clock(const Lasers& lasers, LogPlan& plan) const;
  OdometrySource odometry_source(const Lasers& lasers, const LogPlan& plan) const;
  geometry::Pose2 base_from_laser(const Lasers& lasers) const;
  LogFigures figures(const Lasers& lasers, const LogPlan& plan, double fallback_field_of_view_rad) const;

  OdometryRecordKind odometry_lines() const;
  const OdometryLines& chosen_odometry_lines() const { return odometry_lines_[static_cast<std::size_t>(odometry_lines())]; }

  std::deque<Lasers> lasers_;
  std::array<OdometryLines, 2> odometry_lines_;   // by OdometryRecordKind
  std::optional<StampedPose> newest_odom_;        // by ipc time
  std::optional<StampedPose> newest_odom_by_order_;
  std::int64_t lines_ = 0;
  std::uint64_t imu_lines_ = 0;
  std::array<LaserParams, 2> params_;             // of the front scanner and of the rear one
  std::array<LaserParams, 9> numbered_params_;    // robot_laserN_*, by slot from 1 on
};

}  // namespace slammot::files
