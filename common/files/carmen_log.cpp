#include "common/files/carmen_log.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "common/files/leg_tracker_log.hpp"

namespace slammot::files {
namespace {

constexpr std::size_t kMaxWaitingScans = 256;

template <typename... Visitors>
struct Overloaded : Visitors... {
  using Visitors::operator()...;
};

/// A CARMEN log, or a folder that can be told as one.
Result<std::unique_ptr<LineSource>> open_lines(const std::filesystem::path& path) {
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored)) return LegTrackerLog::open(path);
  auto lines = LineReader::open(path);
  if (!lines) return lines.error();
  return std::unique_ptr<LineSource>(std::make_unique<LineReader>(std::move(*lines)));
}

/// What a record that is kept takes, and next to what its readings take.
std::size_t bytes_of(const CarmenRecord& record) {
  const auto* laser = std::get_if<LaserRecord>(&record);
  return sizeof record + (laser != nullptr ? laser->range_m.size() * sizeof(float) : 0);
}

/// Without what points into the line that it was read from.
CarmenRecord to_keep(CarmenRecord record) {
  if (auto* param = std::get_if<ParamRecord>(&record)) *param = {};
  return record;
}

Error no_scans(const std::filesystem::path& path, const LineSource& lines, std::uint64_t malformed_lines) {
  std::string message = path.string() + ": no laser scan (FLASER or ROBOTLASER1) in " + std::to_string(lines.line_number()) + " lines";
  if (malformed_lines > 0) message += ", " + std::to_string(malformed_lines) + " of them malformed";
  if (lines.is_cut()) message += "; the file is cut off or damaged";
  return Error{std::move(message)};
}

}  // namespace

Result<CarmenLog> CarmenLog::open(const std::filesystem::path& path, const CarmenLogOptions& options) {
  auto opened = open_lines(path);
  if (!opened) return opened.error();
  std::unique_ptr<LineSource> first_pass = std::move(*opened);
  CarmenSurvey survey;
  std::deque<ReadRecord> records;
  std::size_t bytes = 0;
  std::uint64_t malformed_lines = 0;
  while (const auto line = first_pass->next()) {
    CarmenRecord record = parse_carmen_line(*line);
    malformed_lines += std::holds_alternative<MalformedLine>(record) ? 1 : 0;
    survey.add(record);
    bytes += bytes_of(record);
    if (bytes <= options.most_kept_bytes) records.push_back({to_keep(std::move(record)), first_pass->line_number(), first_pass->overlong_lines(), first_pass->fraction_read()});
    else records.clear();
  }
  const LogPlan plan = survey.conclude(options.fallback_field_of_view_rad);
  if (plan.figures.scans == 0) return no_scans(path, *first_pass, malformed_lines);
  if (bytes <= options.most_kept_bytes) {
    CarmenLog log(std::move(first_pass), plan, options);
    log.kept_ = std::move(records);
    log.all_is_kept_ = true;
    return log;
  }
  auto second_pass = open_lines(path);
  if (!second_pass) return second_pass.error();
  return CarmenLog(std::move(*second_pass), plan, options);
}

CarmenLog CarmenLog::follow(std::unique_ptr<LineSource> lines, LogPlan plan, const CarmenLogOptions& options) {
  CarmenLog log(std::move(lines), std::move(plan), options);
  log.survey_.emplace();
  return log;
}

CarmenLog::CarmenLog(std::unique_ptr<LineSource> lines, LogPlan plan, const CarmenLogOptions& options)
    : lines_(std::move(lines)), plan_(std::move(plan)) {
  set_options(options);
}

void CarmenLog::set_options(const CarmenLogOptions& options) {
  options_ = options;
  if (plan_.base_from_laser == geometry::Pose2::identity()) plan_.base_from_laser = options.fallback_base_from_laser;
}

std::optional<LogEvent> CarmenLog::next() {
  while (ready_.empty() && !is_finished_) {
    if (!read_on()) {
      finish_reading();
      continue;
    }
    if (survey_) survey_->add(now_.record);
    std::visit(Overloaded{[this](const IgnoredLine&) { ++faults_.ignored_lines; }, [this](const MalformedLine&) { note_malformed(); },
                          [](const ParamRecord&) {},  // heeded by the survey
                          [this](const OdometryRecord& known) { take(known); },
                          [this](LaserRecord& known) { take(std::move(known)); }},
               now_.record);
    faults_.overlong_lines = now_.overlong_lines;
  }
  if (ready_.empty()) return std::nullopt;
  LogEvent event = std::move(ready_.front());
  ready_.pop_front();
  return event;
}

/// The next record, kept or from the lines: now_. False at the end.
bool CarmenLog::read_on() {
  if (!kept_.empty()) {
    now_ = std::move(kept_.front());
    kept_.pop_front();
    return true;
  }
  if (all_is_kept_) return false;
  const auto line = lines_->next();
  if (!line) return false;
  now_ = {parse_carmen_line(*line), lines_->line_number(), lines_->overlong_lines(), lines_->fraction_read()};
  return true;
}

void CarmenLog::take(LaserRecord record) {
  if (record.kind != plan_.laser) {
    ++faults_.ignored_lines;
    return;
  }
  const auto stamp = stamp_ns(record.stamps);
  if (!stamp) return note_malformed();
  const geometry::Pose2 wheel_from_base = record.wheel_from_base;
  sensing::LaserScan scan = scan_of(std::move(record), *stamp);
  if (++scans_ == 1 && plan_.first_scan_is_ahead) {
    first_scan_ = std::move(scan);  // told first, it would make all others late: after the second one, it is only far ahead
    return;
  }
  switch (plan_.odometry) {
    case OdometrySource::kNone:
      return put_scan(std::move(scan), std::nullopt);
    case OdometrySource::kLaserRecords:
    case OdometrySource::kBoth:
      put_odometry_until(scan.stamp_ns - 1);
      return put_scan(std::move(scan), wheel_from_base);
    case OdometrySource::kOdomLines:
      waiting_.push_back(std::move(scan));
      // Without a common clock the line before the scan is the best there is.
      return put_waiting_scans(plan_.clock == LogClock::kNominal ? 0 : kMaxWaitingScans);
  }
}

void CarmenLog::take(const OdometryRecord& record) {
  if (plan_.odometry == OdometrySource::kNone || plan_.odometry == OdometrySource::kLaserRecords) return;
  // On the nominal clock a line has the time of the scan before it; only the last one before each scan survives.
  const auto stamp = plan_.clock == LogClock::kNominal ? std::optional<std::int64_t>(0) : stamp_ns(record.stamps);
  if (!stamp) return note_malformed();
  if (plan_.clock == LogClock::kNominal) odom_lines_.clear();
  const bool is_believed = odometry_stamps_.believes(*stamp);
  if (!is_believed || (!odom_lines_.empty() && *stamp <= odom_lines_.back().stamp_ns)) {
    ++faults_.stale_odometry;
    return;
  }
  odom_lines_.push_back({*stamp, record.wheel_from_base});
  if (plan_.odometry == OdometrySource::kOdomLines && plan_.clock != LogClock::kNominal) put_waiting_scans(kMaxWaitingScans);
}

void CarmenLog::note_malformed() {
  ++faults_.malformed_lines;
  last_malformed_line_ = now_.line_number;
  if (faults_.first_malformed_lines.size() < LogFaults::kNamedLines) faults_.first_malformed_lines.push_back(now_.line_number);
}

void CarmenLog::finish_reading() {
  is_finished_ = true;
  // A last line that has no end and makes no sense was cut in the middle.
  const bool last_line_is_broken = lines_->last_line_is_unfinished() && last_malformed_line_ == lines_->line_number();
  faults_.is_cut = lines_->is_cut() || last_line_is_broken;
  put_waiting_scans(0);
  if (survey_) plan_.figures = survey_->conclude(options_.fallback_field_of_view_rad).figures;
}

std::optional<std::int64_t> CarmenLog::stamp_ns(const CarmenStamps& stamps) const {
  switch (plan_.clock) {
    case LogClock::kIpc: return stamps.ipc_ns;
    case LogClock::kLogger: return stamps.logger_ns;
    case LogClock::kNominal: return std::llround(1e9 / kNominalRateHz * static_cast<double>(scans_));
  }
  return std::nullopt;
}

sensing::LaserScan CarmenLog::scan_of(LaserRecord record, std::int64_t stamp_ns) const {
  const BeamLayout layout = record.layout.value_or(layout_by_convention(record.range_m.size(), options_.fallback_field_of_view_rad));
  sensing::LaserScan scan;
  scan.stamp_ns = stamp_ns;
  scan.sequence = scans_;
  scan.scanner.scanner_id = options_.scanner_id;
  scan.scanner.base_from_laser = plan_.base_from_laser;
  scan.scanner.first_beam_rad = layout.first_beam_rad;
  scan.scanner.beam_step_rad = layout.beam_step_rad;
  scan.scanner.max_range_m = record.max_range_m > 0.0 ? std::min(record.max_range_m, plan_.max_range_m) : plan_.max_range_m;
  scan.range_m = std::move(record.range_m);
  return scan;
}

void CarmenLog::put_odometry(const sensing::Odometry& odometry) {
  newest_odometry_ = odometry;
  ready_.emplace_back(odometry);
}

/// Hands out the held back ODOM lines up to this time that are newer than what was handed out before.
void CarmenLog::put_odometry_until(std::int64_t stamp_ns) {
  for (; !odom_lines_.empty() && odom_lines_.front().stamp_ns <= stamp_ns; odom_lines_.pop_front()) {
    if (newest_odometry_ && odom_lines_.front().stamp_ns <= newest_odometry_->stamp_ns) {
      ++faults_.stale_odometry;
    } else {
      put_odometry(odom_lines_.front());
    }
  }
}

void CarmenLog::put_waiting_scans(std::size_t may_wait) {
  while (!waiting_.empty()) {
    const bool has_odometry = !odom_lines_.empty() && odom_lines_.back().stamp_ns >= waiting_.front().stamp_ns;
    if (!has_odometry && waiting_.size() <= may_wait) return;
    sensing::LaserScan scan = std::move(waiting_.front());
    waiting_.pop_front();
    if (plan_.clock == LogClock::kNominal) {
      const auto pose = odom_lines_.empty() ? std::nullopt : std::optional(odom_lines_.back().wheel_from_base);
      put_scan(std::move(scan), pose);
      continue;
    }
    put_odometry_until(scan.stamp_ns - 1);
    const auto wheel_from_base = wheel_from_base_at(scan.stamp_ns);
    put_scan(std::move(scan), wheel_from_base);
  }
}

/// Between what was handed out last and the first line held back; the nearer of the two where there is only one.
std::optional<geometry::Pose2> CarmenLog::wheel_from_base_at(std::int64_t stamp_ns) const {
  if (odom_lines_.empty()) return newest_odometry_ ? std::optional(newest_odometry_->wheel_from_base) : std::nullopt;
  const sensing::Odometry& after = odom_lines_.front();
  if (!newest_odometry_ || after.stamp_ns <= newest_odometry_->stamp_ns) return after.wheel_from_base;
  const double fraction = static_cast<double>(stamp_ns - newest_odometry_->stamp_ns) / static_cast<double>(after.stamp_ns - newest_odometry_->stamp_ns);
  return geometry::interpolate(newest_odometry_->wheel_from_base, after.wheel_from_base, std::clamp(fraction, 0.0, 1.0));
}

void CarmenLog::put_scan(sensing::LaserScan scan, const std::optional<geometry::Pose2>& wheel_from_base) {
  const bool is_believed = scan_stamps_.believes(scan.stamp_ns);
  if (is_believed && wheel_from_base && (!newest_odometry_ || scan.stamp_ns > newest_odometry_->stamp_ns)) put_odometry({scan.stamp_ns, *wheel_from_base});
  if (first_scan_) std::swap(first_scan_->sequence, scan.sequence);  // they count in the order in which they are told
  ready_.emplace_back(std::move(scan));
  if (first_scan_) ready_.emplace_back(*std::exchange(first_scan_, std::nullopt));
}

}  // namespace slammot::files
