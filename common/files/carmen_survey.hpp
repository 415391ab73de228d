#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <limits>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "common/files/carmen_record.hpp"
#include "common/files/result.hpp"
#include "common/files/topic_choice.hpp"
#include "common/matching/log_evidence.hpp"
#include "common/matching/timing_pairs.hpp"
#include "common/sensing/companions.hpp"
#include "common/sensing/odometry_sampling.hpp"
#include "common/sensing/own_body.hpp"
#include "common/sensing/scan_times.hpp"
#include "common/sensing/spatial_mounting.hpp"
#include "common/sensing/stamp_guard.hpp"

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
  double median_range_m = 0.0;               ///< Of the echoes.
  double far_range_m = 0.0;                  ///< 90 % of the echoes are nearer.
  double scan_period_s = 0.0;                ///< Median.
  double longest_gap_s = 0.0;                ///< Between two scans.
  double echo_share = 0.0;                   ///< Of all readings.
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
  double max_range_m = 0.0;       ///< As in LogPlan.
  sensing::OwnBody own_body;      ///< In recorded units, as readings are written.
  bool mounting_is_known = true;  ///< From the log; otherwise base_from_laser is a guess.
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
  OdometryRecordKind odometry_lines = OdometryRecordKind::kOdom;  ///< Which lines count as ODOM.
  std::size_t odometry_held_scans = 0;  ///< Odometry comes less often than scans, which repeat its
                                        ///< last pose, at most for so many scans while the vehicle
                                        ///< moves: between them it is interpolated. 0: with each.
  std::size_t odometry_smoothed_over = 0;  ///< Odometry is noisy from one to the next: each is
                                           ///< smoothed over so many on either side. 0: as it is.
  bool odometry_is_too_noisy = false;      ///< Therefore it is not used,
  bool odometry_is_too_rare = false;       ///< or therefore.
  double odometry_late_s = 0.0;  ///< Lateness of its stamps against the scans; removed on reading.
  std::vector<std::int64_t> odometry_stamps_ns;  ///< Of ODOM lines, without the noise of the
                                                 ///< recorded ones. Empty: the recorded ones.
  double odometry_stamp_noise_s = 0.0;           ///< One sigma of it.
  geometry::Pose2 base_from_laser;
  double max_range_m = 0.0;  ///< Readings at or beyond it are "no echo"; a scan's own record may
                             ///< have a lower limit.
  bool scans_are_sorted = false;     ///< They were logged in another order.
  bool first_scan_is_ahead = false;  ///< The next two scans have consistent stamps far before the
                                     ///< first one's.
  LogFigures figures;

  /// True if scans have other stamps than recorded, which have nothing to do with those of other
  /// records: these count by their order. Stamps without noise are of the same clock.
  bool is_timed_by_order() const {
    return !times.stamps_ns.empty() && times.fault != sensing::ClockFault::kNoisy;
  }
};

inline constexpr double kNominalRateHz = 10.0;

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

 private:
  struct StampedPose {
    std::int64_t stamp_ns = 0;
    geometry::Pose2 wheel_from_base;
  };

  /// Tests whether stamps advance like a clock.
  class ClockCheck {
   public:
    void add(std::optional<std::int64_t> stamp_ns);
    bool is_usable() const;
    bool begins_ahead() const { return begins_ahead_; }

   private:
    void restart_without_first();

    std::vector<std::int64_t> first_ns_;  // three of them
    bool begins_ahead_ = false;
    std::uint64_t scans_ = 0;
    std::uint64_t advancing_ = 0;       // newer than all before
    bool counts_scans_ = true;          // whole numbers one second apart
    sensing::StampGuard guard_{600.0};  // localization handles single wrong stamps
    std::optional<std::int64_t> newest_ns_;
    std::vector<std::int64_t> steps_ns_;
  };

  /// Tests whether interpolated ODOM lines equal the poses of the laser records.
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

  /// Sample of scan pairs with little motion in between, spread over the log, limited in number.
  class PairSample {
   public:
    /// A pair ends after this way or turn; it is dropped if the way exceeds the maximum.
    PairSample(double moved_m, double turned_rad, double most_m)
        : moved_m_(moved_m), turned_rad_(turned_rad), most_m_(most_m) {}

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

  /// Statistics of one kind of laser record of one scanner.
  struct Lasers {
    LaserRecordKind kind = LaserRecordKind::kFlaser;
    std::uint8_t slot = 1;
    std::string scanner;
    std::uint64_t scans = 0;
    std::map<std::size_t, std::uint64_t> scans_by_beams;
    std::map<double, std::uint64_t> scans_by_recorded_max_range;
    std::optional<BeamLayout> layout;
    std::vector<std::uint32_t> readings_by_cm;  // up to 650 m
    std::vector<float> smallest_reading_by_cm;
    std::vector<StampedPose> poses;  // by ipc time, 0 where there is none
    std::vector<std::optional<std::int64_t>> ipc_ns;
    std::vector<std::optional<std::int64_t>> logger_ns;
    /// Lines of one OdometryRecordKind between scans.
    struct LinesBetween {
      std::uint32_t since_scan = 0;
      std::vector<std::uint32_t> before_scan;  // how many, by scan
      std::vector<geometry::Pose2> pose_before_scan;
    };
    std::array<LinesBetween, 2> lines_between;                 // by OdometryRecordKind
    std::optional<geometry::Pose2> base_from_laser;            // of the first record
    std::optional<sensing::SpatialMounting> profile_mounting;  // of bags
    bool base_from_laser_is_constant = true;
    ClockCheck ipc_clock;
    ClockCheck logger_clock;
    AgreementCheck agreement;           // by ipc time
    AgreementCheck agreement_by_order;  // by the lines' order in the log
    bool pose_changes = false;
    sensing::HeldPoses held_poses;
    sensing::PoseNoise pose_noise;
    std::uint64_t readings = 0;
    std::uint64_t scans_without_readings = 0;
    std::vector<std::uint32_t> readings_by_unit;  // as written, whatever the unit
    sensing::OwnBodySurvey own_body;
    sensing::Companions companions;
    std::optional<geometry::Pose2> last_recorded;  // of the odometry that pairs are judged by
    matching::OdometryCheck odometry_check;
    // whatever the unit
    PairSample moved_pairs{0.25, 0.12, std::numeric_limits<double>::infinity()};
    PairSample pairs_in_small_units{
        250.0, 0.12, std::numeric_limits<double>::infinity()};  // of odometry in millimetres
    PairSample turned_pairs{1.2, 0.05, 1.2};                    // of a vehicle that seldom turns
    matching::TimingPairs timing_pairs;

    const std::vector<std::optional<std::int64_t>>& stamps_ns(LogClock clock) const {
      return clock == LogClock::kIpc ? ipc_ns : logger_ns;
    }
  };

  void add_laser(const LaserRecord& record);
  static std::vector<float> without_companions(const LaserRecord& record,
                                               const geometry::Pose2& recorded, Lasers& lasers);
  void add_odom(const OdometryRecord& record);
  void add_param(const ParamRecord& record);

  /// Mounting of one scanner by PARAM lines.
  struct LaserParams {
    std::array<std::optional<double>, 3> offset;  // x, y [m], heading [rad]
    sensing::Tilt tilt;
    std::optional<double> max_range_m;

    bool tell_mounting() const { return offset[0] || offset[1] || offset[2]; }
  };

  /// Statistics of ODOM lines, and of TRUEPOS lines in their place.
  struct OdometryLines {
    std::uint64_t count = 0;
    std::optional<geometry::Pose2> first_pose;
    geometry::Pose2 last_pose;
    bool pose_changes = false;
    matching::OdometryCheck check;
    sensing::PoseNoise noise;
    std::vector<geometry::Pose2> poses;
    std::vector<std::optional<std::int64_t>> ipc_ns;
    std::vector<std::optional<std::int64_t>> logger_ns;

    const std::vector<std::optional<std::int64_t>>& stamps_ns(LogClock clock) const {
      return clock == LogClock::kIpc ? ipc_ns : logger_ns;
    }
  };

  Lasers& lasers_of(const LaserRecord& record);
  std::vector<const Lasers*> best_of_each_slot(const ScannerWish& wish) const;
  std::vector<const Lasers*> planar_scanners(const ScannerWish& wish) const;
  std::optional<sensing::SpatialMounting> profile_mounting(const Lasers& lasers,
                                                           const ScannerWish& wish) const;
  std::vector<const Lasers*> lasers_to_use(const ScannerWish& wish) const;
  const LaserParams& params_of(const Lasers& lasers) const;
  bool mounting_is_known(const Lasers& lasers) const;
  ScannerPlan scanner_plan(const Lasers& lasers) const;
  double max_range_m(const Lasers& lasers) const;
  static void convert_readings(Lasers& lasers, double unit_m);
  static std::vector<std::int64_t> scan_stamps_ns(const Lasers& lasers, const LogPlan& plan);
  static std::vector<sensing::Odometry> odometry_of_scans(const Lasers& lasers,
                                                          const LogPlan& plan);
  std::vector<sensing::Odometry> odometry_of_lines(const LogPlan& plan) const;
  std::vector<sensing::Odometry> odometry_of(const Lasers& lasers, const LogPlan& plan) const;
  double odometry_lateness_s(const Lasers& lasers, const LogPlan& plan,
                             double fallback_field_of_view_rad) const;
  static double fine_odometry_lateness_s(const Lasers& lasers, const LogPlan& plan,
                                         double fallback_field_of_view_rad,
                                         std::span<const double> scan_times_s,
                                         std::span<const matching::TimedPose> of_base,
                                         double roughly_s);
  static std::vector<matching::ScanPair> with_echoes_of_others(
      const Lasers& lasers, const LogPlan& plan, std::vector<matching::ScanPair> pairs);
  static matching::AssumedBeams assumed_beams(const Lasers& lasers, const LogPlan& plan,
                                              std::size_t beams, double fallback_field_of_view_rad);
  void treat_poor_odometry(const Lasers& lasers, LogPlan& plan) const;
  void remove_noise_of_odometry_stamps(LogPlan& plan) const;
  matching::LogEvidence weigh(const Lasers& lasers, const LogPlan& plan,
                              double fallback_field_of_view_rad) const;
  std::vector<sensing::ScanMark> scan_marks(const Lasers& lasers,
                                            const matching::LogCorrection& correction,
                                            LogClock clock) const;
  void choose_clock(const Lasers& lasers, LogPlan& plan) const;
  OdometrySource odometry_source(const Lasers& lasers, const LogPlan& plan) const;
  geometry::Pose2 base_from_laser(const Lasers& lasers) const;
  LogFigures figures(const Lasers& lasers, const LogPlan& plan,
                     double fallback_field_of_view_rad) const;

  OdometryRecordKind odometry_lines() const;
  const OdometryLines& chosen_odometry_lines() const {
    return odometry_lines_[static_cast<std::size_t>(odometry_lines())];
  }

  std::deque<Lasers> lasers_;
  std::array<OdometryLines, 2> odometry_lines_;  // by OdometryRecordKind
  std::optional<StampedPose> newest_odom_;       // by ipc time
  std::optional<StampedPose> newest_odom_by_order_;
  std::int64_t lines_ = 0;
  std::uint64_t imu_lines_ = 0;
  std::array<LaserParams, 2> params_;           // of the front scanner and of the rear one
  std::array<LaserParams, 9> numbered_params_;  // robot_laserN_*, by slot from 1 on
};

}  // namespace slammot::files
