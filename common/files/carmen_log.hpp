#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <numbers>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "common/files/carmen_record.hpp"
#include "common/files/carmen_survey.hpp"
#include "common/files/line_source.hpp"
#include "common/files/record_source.hpp"
#include "common/files/result.hpp"
#include "common/files/topic_choice.hpp"
#include "common/sensing/gyro_odometry.hpp"
#include "common/sensing/pose_smoother.hpp"
#include "common/sensing/scan.hpp"
#include "common/sensing/stamp_guard.hpp"

namespace slammot::files {

struct CarmenLogOptions {
  std::string scanner_id = "front";
  double fallback_field_of_view_rad = std::numbers::pi;  ///< First to last beam, if the records
                                                         ///< have none.
  geometry::Pose2 fallback_base_from_laser;              ///< If the log has no mounting.
  TopicOptions topics;                                   ///< For logs with several candidates.
  bool uses_all_scanners = false;  ///< False: only the main scanner's scans are returned.
  bool is_as_live = false;         ///< True: as live sensors publish it. See as_live().
  bool reads_profiles = false;     ///< True: scans of LogPlan::profile_scanners are returned, too.
  std::size_t most_kept_bytes = std::size_t{48} << 20;  ///< Of records kept by open(): 15 min at 40
                                                        ///< Hz; larger logs are read twice.
};

/// Unusable lines, counted while the log is read.
struct LogFaults {
  static constexpr std::size_t kNamedLines = 5;
  std::uint64_t malformed_lines = 0;  ///< Known records with too few or impossible numbers;
                                      ///< skipped.
  std::vector<std::uint64_t> first_malformed_lines;  ///< Their line numbers from 1, at most
                                                     ///< kNamedLines.
  std::uint64_t overlong_lines = 0;                  ///< Beyond LineReader::kMaxLineBytes; skipped.
  std::uint64_t ignored_lines = 0;                   ///< Comments and unused messages.
  std::uint64_t stale_odometry = 0;                  ///< Not newer than returned odometry; skipped.
  bool is_cut = false;                               ///< The file is truncated or damaged.
  std::string damage;                                ///< Kind and place of the damage, if known.
};

using LogEvent =
    std::variant<sensing::Odometry, sensing::LaserScan, sensing::GnssFix, sensing::CompassReading>;

/// A log as a stream of sensor events in the order of the log: CARMEN text and the formats of
/// open_records().
///
/// Opening reads the whole log once (CarmenSurvey) and decides how to interpret it; next() returns
/// kept records, or reads again if there are too many. A source that can be read only once is
/// surveyed while it is read.
/// - Stamps are the log's ipc_timestamp where that is a clock; see LogClock. Where LogPlan::times
/// replaces the scans' stamps,
///   ODOM lines are placed between them by their order.
/// - Where the log has odometry, each scan comes right after an Odometry of the scan's very stamp,
/// and the stamps of
///   Odometry always grow; see OdometrySource for ODOM lines. A scan that is not newer than those
///   before it comes without one.
/// - sequence counts the scans handed out, from 0, of each scanner.
/// - Of several scanners the main one's scans are handed out, or all in the order of their stamps
/// (uses_all_scanners), each with
///   its own mounting and a scanner_id of its own: the topic or the message's name.
/// - A scan's range_m is as in the log, NaN for what was no number; sensing::is_echo() tells echoes
/// from the rest.
/// - Fixes and compass readings come in the order of the log, stamped by its clock; without a clock
/// they are ignored.
/// - Where the log has an IMU and a clock, the turns of the odometry are those of its gyro
/// (sensing::GyroOdometry).
/// - sweep_s is left 0: a log does not say it. See sweep_s_for() in log_profile.hpp.
class CarmenLog {
 public:
  /// Fails for a file that cannot be read or that holds no scan.
  static Result<CarmenLog> open(const std::filesystem::path& path,
                                const CarmenLogOptions& options = {});

  /// For lines that can be read only once: their format must be known, and the plan has no
  /// statistics. The statistics are known at the end.
  static CarmenLog follow(std::unique_ptr<LineSource> lines, LogPlan plan,
                          const CarmenLogOptions& options = {});

  /// Replaces the options, since a profile may depend on plan(). Call before the first next().
  void set_options(const CarmenLogOptions& options);

  /// The next event; nullopt at the end of the readable part.
  std::optional<LogEvent> next();

  const LogPlan& plan() const { return plan_; }
  const LogFaults& faults() const { return faults_; }
  const TopicChoice& topics() const { return topics_; }

  /// Up to the last event of next(). None without a reading beside odometry.
  std::optional<sensing::GyroUse> gyro_use() const;

  /// Of the scans returned by next().
  std::vector<std::string> scanner_ids() const;

  /// Name of a scanner in its scans, if several are returned.
  static std::string scanner_id_of(std::string_view scanner);

  /// Share of the file read by next(), [0, 1].
  double fraction_read() const { return now_.fraction_read; }

 private:
  CarmenLog(std::unique_ptr<RecordSource> records, LogPlan plan, const CarmenLogOptions& options);

  /// One parsed line.
  struct ReadRecord {
    CarmenRecord record;
    std::uint64_t line_number = 0;
    std::uint64_t overlong_lines = 0;  ///< So far,
    double fraction_read = 0.0;        ///< as is this.
  };
  struct FirstPass {
    std::unique_ptr<RecordSource> records;  ///< At their end.
    CarmenSurvey survey;
    std::deque<ReadRecord> kept;
    bool has_kept_all = true;
    std::uint64_t malformed_lines = 0;
    std::string_view why_malformed;  ///< Of the first one of which it is known.
  };
  using RecordOpener = std::function<Result<std::unique_ptr<RecordSource>>()>;
  static Result<FirstPass> read_once(const RecordOpener& open, std::size_t most_kept_bytes);

  bool read_on();
  void take(LaserRecord record);
  void take_in_order(LaserRecord record, std::size_t scanner, std::int64_t stamp_ns);
  void merge_scans(std::size_t may_wait);
  bool has_several_scanners() const {
    return (options_.uses_all_scanners && plan_.scanners.size() > 1) || options_.reads_profiles;
  }
  const ScannerPlan& scanner_plan(std::size_t scanner) const;
  std::optional<std::size_t> scanner_of(const LaserRecord& record) const;
  void take(const OdometryRecord& record);
  void take(const GnssRecord& record);
  void take(const CompassRecord& record);
  void take(const ImuRecord& record);
  void note_malformed();
  void finish_reading();
  bool is_timed_by_order() const { return plan_.is_timed_by_order(); }
  std::optional<std::int64_t> recorded_stamp_ns(const CarmenStamps& stamps) const;
  std::optional<std::int64_t> scan_stamp_ns(const CarmenStamps& stamps, std::size_t scanner) const;
  std::optional<std::int64_t> odometry_stamp_by_order_ns();
  std::optional<std::int64_t> odometry_stamp_ns(const CarmenStamps& stamps);
  sensing::LaserScan scan_of(LaserRecord record, std::size_t scanner, std::int64_t stamp_ns) const;
  void correct(sensing::LaserScan& scan, std::size_t scanner) const;
  bool has_beams_of_the_main_one(std::size_t scanner) const;
  bool waits_for_odometry() const;
  bool waits_for_sweep() const;
  std::int64_t slow_sweep_ns() const;
  bool smooth_and_keep(const sensing::Odometry& odometry);
  bool is_fresh(const geometry::Pose2& wheel_from_base);
  bool keep_odometry(const sensing::Odometry& odometry);
  void put_odometry(const sensing::Odometry& odometry);
  void put_odometry_until(std::int64_t stamp_ns);
  void put_waiting_scans(std::size_t may_wait);
  void put_odometry_through(std::int64_t stamp_ns);
  void put_pose_at(std::int64_t stamp_ns, const std::optional<geometry::Pose2>& wheel_from_base);
  void put_scan(sensing::LaserScan scan);
  bool is_long_before_odometry(std::int64_t stamp_ns) const;
  std::optional<geometry::Pose2> wheel_from_base_at(std::int64_t stamp_ns) const;

  /// A scan that waits for older scans of other scanners.
  struct MergingScan {
    LaserRecord record;
    std::size_t scanner = 0;
  };

  std::unique_ptr<RecordSource> records_;
  TopicChoice topics_;
  bool is_choice_of_plan_ = false;  // topics_, where the log has no topics
  std::deque<ReadRecord> kept_;     // what is still to come, where
  bool all_is_kept_ = false;        // the survey's records were few enough
  ReadRecord now_;
  std::optional<CarmenSurvey> survey_;  // of lines that were not surveyed before
  LogPlan plan_;
  CarmenLogOptions options_;
  LogFaults faults_;
  std::uint64_t last_malformed_line_ = 0;
  bool is_finished_ = false;
  std::vector<std::uint32_t> scans_ = {0};            // by scanner
  std::size_t odometry_lines_ = 0;                    // of the kind in use
  std::uint32_t odom_lines_since_scan_ = 0;           // of the main scanner
  std::multimap<std::int64_t, MergingScan> merging_;  // by stamp
  std::deque<LogEvent> ready_;
  std::deque<sensing::Odometry> odom_lines_;      // held back until the scan after them
  std::optional<sensing::LaserScan> first_scan_;  // until the second one, where its stamp is far
                                                  // ahead
  std::deque<sensing::LaserScan> waiting_;  // kOdomLines: until an ODOM line as new as the scan
  sensing::StampGuard scan_stamps_{60.0};   // one from the future must not keep back all odometry
                                            // after it
  sensing::StampGuard odometry_stamps_{60.0};
  sensing::StampGuard gyro_stamps_{60.0};
  std::optional<sensing::Odometry> newest_odometry_;  // handed out
  std::optional<geometry::Pose2> held_pose_;          // of the last scan
  std::size_t held_scans_ = 0;
  std::optional<sensing::PoseSmoother> smoother_;
  std::optional<std::int64_t> newest_to_smooth_ns_;
  matching::PoseCorrection pose_correction_;  // of poses in the order of the log
  sensing::GyroOdometry gyro_;
};

}  // namespace slammot::files
