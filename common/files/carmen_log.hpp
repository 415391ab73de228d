#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <memory>
#include <numbers>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "common/files/carmen_record.hpp"
#include "common/files/carmen_survey.hpp"
#include "common/files/line_reader.hpp"
#include "common/files/result.hpp"
#include "common/sensing/scan.hpp"
#include "common/sensing/stamp_guard.hpp"

namespace slammot::files {

struct CarmenLogOptions {
  std::string scanner_id = "front";
  double fallback_field_of_view_rad = std::numbers::pi;  ///< First to last beam, where the records do not say.
  geometry::Pose2 fallback_base_from_laser;              ///< Where the log does not say where the laser is.
  std::size_t most_kept_bytes = std::size_t{48} << 20;   ///< Of records read by open(), a quarter of an hour at 40 Hz; more are read again.
};

/// Lines that were of no use, counted while the log is read.
struct LogFaults {
  static constexpr std::size_t kNamedLines = 5;
  std::uint64_t malformed_lines = 0;                ///< Records of ours with too few or impossible numbers; skipped.
  std::vector<std::uint64_t> first_malformed_lines; ///< Their line numbers from 1, at most kNamedLines.
  std::uint64_t overlong_lines = 0;                 ///< Beyond LineReader::kMaxLineBytes; skipped.
  std::uint64_t ignored_lines = 0;                  ///< Comments and messages that are no input of ours.
  std::uint64_t stale_odometry = 0;                 ///< Not newer than odometry already handed out; left out.
  bool is_cut = false;                              ///< The file ends before the log does.
};

using LogEvent = std::variant<sensing::Odometry, sensing::LaserScan>;

/// A CARMEN log as a stream of what the vehicle's sensors said, in the order of the log.
///
/// Opening reads the whole log once (CarmenSurvey) and decides how to understand it; next() hands out what was read, or
/// reads it again where that is too much to keep. Lines of a source that cannot be read twice are followed instead.
/// - Stamps are the log's ipc_timestamp where that is a clock; see LogClock.
/// - Where the log has odometry, each scan comes right after an Odometry of the scan's very stamp, and the stamps of
///   Odometry always grow; see OdometrySource for ODOM lines. A scan that is not newer than those before it comes
///   without one.
/// - sequence counts the scans handed out, from 0.
/// - A scan's range_m is as in the log, NaN for what was no number; sensing::is_echo() tells echoes from the rest.
/// - sweep_s is left 0: a log does not say it. See sweep_s_for() in log_profile.hpp.
class CarmenLog {
 public:
  /// Fails for a file that cannot be read or that holds no scan. A folder is read as LegTrackerLog does.
  static Result<CarmenLog> open(const std::filesystem::path& path, const CarmenLogOptions& options = {});

  /// Lines that can be read only once, so that what they are must be known: the plan without its figures. Those are known at
  /// the end.
  static CarmenLog follow(std::unique_ptr<LineSource> lines, LogPlan plan, const CarmenLogOptions& options = {});

  /// Replaces the options, which a profile may know only once plan() has chosen it. Before the first next().
  void set_options(const CarmenLogOptions& options);

  /// The next event; nullopt at the end of what can be read.
  std::optional<LogEvent> next();

  const LogPlan& plan() const { return plan_; }
  const LogFaults& faults() const { return faults_; }

  /// Share of the file taken in by next() so far, [0, 1].
  double fraction_read() const { return now_.fraction_read; }

 private:
  CarmenLog(std::unique_ptr<LineSource> lines, LogPlan plan, const CarmenLogOptions& options);

  /// One line, understood.
  struct ReadRecord {
    CarmenRecord record;
    std::uint64_t line_number = 0;
    std::uint64_t overlong_lines = 0;   ///< So far,
    double fraction_read = 0.0;         ///< as is this.
  };

  bool read_on();
  void take(LaserRecord record);
  void take(const OdometryRecord& record);
  void note_malformed();
  void finish_reading();
  std::optional<std::int64_t> stamp_ns(const CarmenStamps& stamps) const;
  sensing::LaserScan scan_of(LaserRecord record, std::int64_t stamp_ns) const;
  void put_odometry(const sensing::Odometry& odometry);
  void put_odometry_until(std::int64_t stamp_ns);
  void put_waiting_scans(std::size_t may_wait);
  void put_scan(sensing::LaserScan scan, const std::optional<geometry::Pose2>& wheel_from_base);
  std::optional<geometry::Pose2> wheel_from_base_at(std::int64_t stamp_ns) const;

  std::unique_ptr<LineSource> lines_;
  std::deque<ReadRecord> kept_;                      // what is still to come, where
  bool all_is_kept_ = false;                         // the survey's records were few enough
  ReadRecord now_;
  std::optional<CarmenSurvey> survey_;               // of lines that were not surveyed before
  LogPlan plan_;
  CarmenLogOptions options_;
  LogFaults faults_;
  std::uint64_t last_malformed_line_ = 0;
  bool is_finished_ = false;
  std::uint32_t scans_ = 0;
  std::deque<LogEvent> ready_;
  std::deque<sensing::Odometry> odom_lines_;         // held back until the scan after them
  std::optional<sensing::LaserScan> first_scan_;     // until the second one, where its stamp is far ahead
  std::deque<sensing::LaserScan> waiting_;           // kOdomLines: until an ODOM line as new as the scan
  sensing::StampGuard scan_stamps_{60.0};            // one from the future must not keep back all odometry after it
  sensing::StampGuard odometry_stamps_{60.0};
  std::optional<sensing::Odometry> newest_odometry_; // handed out
};

}  // namespace slammot::files
