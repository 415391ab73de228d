#include "common/files/carmen_log.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "common/files/live_plan.hpp"
#include "common/files/log_formats.hpp"
#include "common/files/log_profile.hpp"
#include "common/files/repeated_scans.hpp"
#include "common/files/sorted_records.hpp"
#include "common/sensing/blank_reading.hpp"
#include "common/sensing/deskew.hpp"

namespace slammot::files {
namespace {

constexpr std::size_t kMaxWaitingScans = 256;
constexpr std::size_t kMaxMergingScans = 64;
constexpr std::int64_t kMergedOver_ns = 250'000'000;  // scanner latencies differ by less

template <typename... Visitors>
struct Overloaded : Visitors... {
  using Visitors::operator()...;
};
template <class... Visitors>
Overloaded(Visitors...) -> Overloaded<Visitors...>;  // clang before 17 does not deduce it

/// Memory of a kept record, without its readings.
std::size_t bytes_of(const CarmenRecord& record) {
  const auto* laser = std::get_if<LaserRecord>(&record);
  return sizeof record + (laser != nullptr ? laser->range_m.size() * sizeof(float) : 0);
}

/// Copy without references into the line.
CarmenRecord to_keep(CarmenRecord record) {
  if (auto* param = std::get_if<ParamRecord>(&record)) *param = {};
  return record;
}

Error no_scans(const std::filesystem::path& path, const RecordSource& records,
               std::uint64_t malformed_lines, std::string_view why_malformed) {
  std::string message = path.string() + ": no laser scan (FLASER or ROBOTLASER1) in " +
                        std::to_string(records.line_number()) + " lines";
  if (malformed_lines > 0) message += ", " + std::to_string(malformed_lines) + " of them malformed";
  if (!why_malformed.empty()) message += " (one of them: " + std::string(why_malformed) + ")";
  if (records.is_cut()) message += "; the file is cut off or damaged";
  return Error{std::move(message)};
}

/// Scanners of a log that is no bag, if there are several.
TopicChoice choice_of(const LogPlan& plan) {
  TopicChoice choice;
  if (plan.scanners.size() < 2) return choice;
  for (const ScannerPlan& scanner : plan.scanners) {
    TopicCandidate candidate;
    candidate.topic = scanner.name;
    candidate.type = "CARMEN";
    candidate.messages = scanner.scans;
    candidate.is_chosen = choice.scanners.empty();
    choice.scanners.push_back(std::move(candidate));
  }
  return choice;
}

std::vector<std::string> names_of(const std::vector<ScannerPlan>& scanners) {
  std::vector<std::string> names;
  for (const ScannerPlan& scanner : scanners) names.push_back(scanner.name);
  return names;
}

/// The user says that the laser is so much farther ahead and to the left: what the pairs of scans
/// found of odometry's point may be just that.
void take_as_stated(const geometry::Vector2& laser_moved_m, matching::LogCorrection& correction) {
  constexpr double kSame_m = 0.2;
  geometry::Pose2& odometry_from_base = correction.odometry_from_base;
  if (odometry_from_base == geometry::Pose2::identity()) return;
  odometry_from_base.x_m -= laser_moved_m.x();
  odometry_from_base.y_m -= laser_moved_m.y();
  if (odometry_from_base.translation_m().norm() < kSame_m)
    odometry_from_base = geometry::Pose2::identity();
}

/// A wish for a scanner that does not scan the plane, or that the log does not have.
std::optional<Error> find_fault(const ScannerWish& wish, const CarmenSurvey& survey) {
  const std::vector<ScannerPlan> vertical = survey.profile_scanners(wish);
  const auto is_vertical = [&](const std::string& name) {
    return std::ranges::find(vertical, name, &ScannerPlan::name) != vertical.end();
  };
  for (const VerticalScanner& said : wish.vertical) {
    if (!is_vertical(said.name))
      return Error{"--vertical: no scanner " + said.name + " in the log"};
  }
  for (const std::string& name : wish.used) {
    if (is_vertical(name))
      return Error{"scanner " + name +
                   " scans a vertical profile, which is of no use for localization (slammot model "
                   "uses it)"};
  }
  if (is_vertical(wish.main))
    return Error{"--scan-topic " + wish.main + ": it scans a vertical profile"};
  if (survey.scanners(wish).empty() && !vertical.empty())
    return Error{"no scanner scans the plane: " + enumerated(vertical) +
                 " scans a vertical profile"};
  return std::nullopt;
}

}  // namespace

/// Frame laser_<scanner_id>, at most 31 characters: the end of a long topic identifies it better
/// than the start.
std::string CarmenLog::scanner_id_of(std::string_view scanner) {
  constexpr std::size_t kLongest = 24;
  std::string id(scanner.substr(std::min(scanner.find_first_not_of('/'), scanner.size())));
  if (id.size() > kLongest) id.erase(0, id.size() - kLongest);
  std::ranges::replace(id, '/', '_');
  return id;
}

Result<CarmenLog> CarmenLog::open(const std::filesystem::path& path,
                                  const CarmenLogOptions& options) {
  const RecordOptions record_options{options.topics, options.most_kept_bytes};
  std::optional<LogClock> sorted_by;
  StrayOdometry stray;
  const auto open_in_order = [&]() -> Result<std::unique_ptr<RecordSource>> {
    auto opened = open_records(path, record_options);
    if (!opened) return opened;
    std::unique_ptr<RecordSource> records =
        std::make_unique<WithoutRepeatedScans>(std::move(*opened));
    if (sorted_by) records = std::make_unique<SortedRecords>(std::move(records), *sorted_by);
    if (stray.count() > 0)
      records = std::make_unique<WithoutStrayOdometry>(std::move(records), stray);
    return records;
  };
  auto first_pass = read_once(open_in_order, options.most_kept_bytes);
  if (!first_pass) return first_pass.error();
  sorted_by = first_pass->survey.clock_of_disordered_scans();
  if (sorted_by) first_pass = read_once(open_in_order, options.most_kept_bytes);
  if (!first_pass) return first_pass.error();
  if (!options.is_as_live) stray = first_pass->survey.stray_odometry();
  if (stray.count() > 0) first_pass = read_once(open_in_order, options.most_kept_bytes);
  if (!first_pass) return first_pass.error();
  RecordSource& read = *first_pass->records;
  const CarmenSurvey& survey = first_pass->survey;
  const bool has_topics = !read.topics().scanners.empty();  // topics are already selected
  const ScannerWish wish{has_topics ? std::string() : options.topics.scan_topic,
                         options.topics.scanners, options.topics.vertical};
  if (auto fault = find_fault(wish, survey)) return Error{path.string() + ": " + fault->message};
  std::vector<ScannerPlan> scanners = survey.scanners(wish);
  if (scanners.empty())
    return no_scans(path, read, first_pass->malformed_lines, first_pass->why_malformed);
  if (!wish.main.empty() && !survey.has_scanner(wish.main))
    return Error{path.string() + ": no scanner " + wish.main + " in the log: its main one is " +
                 scanners.front().name};
  if (auto fault = select_scanners(wish.used, scanners))
    return Error{path.string() + ": " + fault->message};
  LogPlan plan = survey.conclude(options.fallback_field_of_view_rad, wish);
  plan.scans_are_sorted = sorted_by.has_value();
  plan.repeated_scans = read.repeated_scans();
  plan.stray_odometry = stray.count();
  if (options.is_as_live) plan = as_live(std::move(plan));
  if (first_pass->has_kept_all) {
    CarmenLog log(std::move(first_pass->records), plan, options);
    log.kept_ = std::move(first_pass->kept);
    log.all_is_kept_ = true;
    return log;
  }
  auto second_pass = open_in_order();
  if (!second_pass) return second_pass.error();
  return CarmenLog(std::move(*second_pass), plan, options);
}

/// Surveys all records; keeps them where they are no more than so many bytes.
Result<CarmenLog::FirstPass> CarmenLog::read_once(const RecordOpener& open,
                                                  std::size_t most_kept_bytes) {
  auto opened = open();
  if (!opened) return opened.error();
  FirstPass pass;
  pass.records = std::move(*opened);
  std::size_t bytes = 0;
  while (auto record = pass.records->next()) {
    if (const auto* const malformed = std::get_if<MalformedLine>(&*record)) {
      ++pass.malformed_lines;
      if (pass.why_malformed.empty()) pass.why_malformed = malformed->why;
    }
    pass.survey.add(*record);
    bytes += bytes_of(*record);
    pass.has_kept_all = bytes <= most_kept_bytes;
    if (pass.has_kept_all)
      pass.kept.push_back({to_keep(std::move(*record)), pass.records->line_number(),
                           pass.records->overlong_lines(), pass.records->fraction_read()});
    else pass.kept.clear();
  }
  return pass;
}

CarmenLog CarmenLog::follow(std::unique_ptr<LineSource> lines, LogPlan plan,
                            const CarmenLogOptions& options) {
  CarmenLog log(std::make_unique<CarmenLines>(std::move(lines)), std::move(plan), options);
  log.survey_.emplace();
  return log;
}

CarmenLog::CarmenLog(std::unique_ptr<RecordSource> records, LogPlan plan,
                     const CarmenLogOptions& options)
    : records_(std::move(records)),
      topics_(records_->topics()),
      plan_(std::move(plan)),
      scans_(std::max<std::size_t>(1, plan_.scanners.size() + plan_.profile_scanners.size())) {
  is_choice_of_plan_ = topics_.scanners.empty();
  if (is_choice_of_plan_) topics_ = choice_of(plan_);
  set_options(options);
}

void CarmenLog::set_options(const CarmenLogOptions& options) {
  options_ = options;
  for (std::size_t i = 1; i < topics_.scanners.size() && is_choice_of_plan_; ++i)
    topics_.scanners[i].is_chosen = options.uses_all_scanners;
  // for scans without a mounting in the record
  const geometry::Pose2 unsaid{0.0, 0.0, plan_.evidence.correction.laser_turn_rad};
  if (options.fallback_base_from_laser == geometry::Pose2::identity() ||
      difference(plan_.base_from_laser, unsaid).norm() > 1e-9)
    return;
  const geometry::Vector2 stated_m =
      options.fallback_base_from_laser.translation_m() - plan_.base_from_laser.translation_m();
  plan_.base_from_laser = options.fallback_base_from_laser;
  plan_.evidence.correction.laser_turn_rad = 0.0;
  take_as_stated(stated_m, plan_.evidence.correction);
}

std::optional<LogEvent> CarmenLog::next() {
  while (ready_.empty() && !is_finished_) {
    if (!read_on()) {
      finish_reading();
      continue;
    }
    if (survey_) survey_->add(now_.record);
    std::visit(Overloaded{[this](const IgnoredLine&) { ++faults_.ignored_lines; },
                          [this](const MalformedLine&) { note_malformed(); },
                          [](const ParamRecord&) {},  // The survey processes it.
                          [this](const ImuRecord& known) { take(known); },
                          [this](const OdometryRecord& known) { take(known); },
                          [this](const GnssRecord& known) { take(known); },
                          [this](const CompassRecord& known) { take(known); },
                          [this](LaserRecord& known) { take(std::move(known)); }},
               now_.record);
    faults_.overlong_lines = now_.overlong_lines;
  }
  if (ready_.empty()) return std::nullopt;
  LogEvent event = std::move(ready_.front());
  ready_.pop_front();
  if (auto* odometry = std::get_if<sensing::Odometry>(&event)) *odometry = gyro_.fused(*odometry);
  return event;
}

std::optional<sensing::GyroUse> CarmenLog::gyro_use() const {
  if (!gyro_.has_readings()) return std::nullopt;
  return gyro_.use();
}

/// Sets now_ to the next record, kept or parsed. Returns false at the end.
bool CarmenLog::read_on() {
  if (!kept_.empty()) {
    now_ = std::move(kept_.front());
    kept_.pop_front();
    return true;
  }
  if (all_is_kept_) return false;
  auto record = records_->next();
  if (!record) return false;
  now_ = {std::move(*record), records_->line_number(), records_->overlong_lines(),
          records_->fraction_read()};
  return true;
}

std::vector<std::string> CarmenLog::scanner_ids() const {
  if (!has_several_scanners()) return {options_.scanner_id};
  std::vector<std::string> ids;
  for (const ScannerPlan& scanner : plan_.scanners) ids.push_back(scanner_id_of(scanner.name));
  return ids;
}

/// Those of profiles follow those of the plane.
const ScannerPlan& CarmenLog::scanner_plan(std::size_t scanner) const {
  return scanner < plan_.scanners.size() ? plan_.scanners[scanner]
                                         : plan_.profile_scanners[scanner - plan_.scanners.size()];
}

/// Index of the record's scanner in the plan; nullopt if the scan is not used.
std::optional<std::size_t> CarmenLog::scanner_of(const LaserRecord& record) const {
  if (plan_.scanners.empty())
    return record.kind == plan_.laser && record.slot == 1 ? std::optional<std::size_t>(0)
                                                          : std::nullopt;
  const auto is_of = [&](std::size_t i) {
    return scanner_plan(i).kind == record.kind && scanner_plan(i).slot == record.slot;
  };
  const std::size_t used = options_.uses_all_scanners ? plan_.scanners.size() : 1;
  for (std::size_t i = 0; i < used; ++i) {
    if (is_of(i)) return i;
  }
  const std::size_t profiles = options_.reads_profiles ? plan_.profile_scanners.size() : 0;
  for (std::size_t i = plan_.scanners.size(); i < plan_.scanners.size() + profiles; ++i) {
    if (is_of(i)) return i;
  }
  return std::nullopt;
}

void CarmenLog::take(LaserRecord record) {
  const auto scanner = scanner_of(record);
  if (!scanner) {
    ++faults_.ignored_lines;
    return;
  }
  const auto stamp = scan_stamp_ns(record.stamps, *scanner);
  if (!stamp) return note_malformed();
  if (*scanner == 0) odom_lines_since_scan_ = 0;
  if (!has_several_scanners() || is_timed_by_order())
    return take_in_order(std::move(record), *scanner, *stamp);
  merging_.emplace(*stamp, MergingScan{std::move(record), *scanner});
  merge_scans(kMaxMergingScans);
}

/// Merges scans of several scanners by stamp: each waits until no older one can come.
void CarmenLog::merge_scans(std::size_t may_wait) {
  while (!merging_.empty()) {
    const std::int64_t span_ns = merging_.rbegin()->first - merging_.begin()->first;
    if (merging_.size() <= may_wait && span_ns <= kMergedOver_ns) return;
    auto oldest = merging_.extract(merging_.begin());
    take_in_order(std::move(oldest.mapped().record), oldest.mapped().scanner, oldest.key());
  }
}

void CarmenLog::take_in_order(LaserRecord record, std::size_t scanner, std::int64_t stamp) {
  const bool has_pose =
      record.kind != LaserRecordKind::kRawLaser && record.kind != LaserRecordKind::kDpSlam;
  const auto wheel_from_base =
      has_pose
          ? std::optional(pose_correction_.next(plan_.evidence.correction, record.wheel_from_base))
          : std::nullopt;
  sensing::LaserScan scan = scan_of(std::move(record), scanner, stamp);
  if (++scans_[scanner] == 1 && scanner == 0 && plan_.first_scan_is_ahead) {
    first_scan_ = std::move(scan);  // if returned first, it would make all others late; after the
                                    // second one it counts as far ahead
    return;
  }
  if (waits_for_odometry()) {
    if (wheel_from_base && plan_.odometry != OdometrySource::kOdomLines &&
        is_fresh(*wheel_from_base))
      smooth_and_keep({stamp - plan_.odometry_lateness_ns(stamp), *wheel_from_base});
    waiting_.push_back(std::move(scan));
    return put_waiting_scans(kMaxWaitingScans);
  }
  switch (plan_.odometry) {
    case OdometrySource::kNone: return put_scan(std::move(scan));
    case OdometrySource::kLaserRecords:
    case OdometrySource::kBoth:
      put_odometry_until(scan.stamp_ns - 1);
      put_pose_at(scan.stamp_ns, wheel_from_base);
      return put_scan(std::move(scan));
    case OdometrySource::kOdomLines:
      waiting_.push_back(std::move(scan));
      return put_waiting_scans(kMaxWaitingScans);
  }
}

void CarmenLog::take(const OdometryRecord& record) {
  if (plan_.odometry == OdometrySource::kNone || plan_.odometry == OdometrySource::kLaserRecords ||
      record.kind != plan_.odometry_lines)
    return;
  const auto stamp =
      is_timed_by_order() ? odometry_stamp_by_order_ns() : odometry_stamp_ns(record.stamps);
  if (!stamp) return is_timed_by_order() ? void() : note_malformed();
  if (!odometry_stamps_.believes(*stamp) ||
      !smooth_and_keep(
          {*stamp - plan_.odometry_lateness_ns(*stamp),
           pose_correction_.next(plan_.evidence.correction, record.wheel_from_base)})) {
    ++faults_.stale_odometry;
    return;
  }
  if (plan_.odometry == OdometrySource::kOdomLines || plan_.odometry_is_late() || waits_for_sweep())
    put_waiting_scans(kMaxWaitingScans);
}

void CarmenLog::take(const GnssRecord& record) {
  const auto stamp = recorded_stamp_ns(record.stamps);
  if (is_timed_by_order()) return void(++faults_.ignored_lines);
  if (!stamp) return note_malformed();
  sensing::GnssFix fix = record.fix;
  fix.stamp_ns = *stamp;
  ready_.emplace_back(std::move(fix));
}

void CarmenLog::take(const CompassRecord& record) {
  const auto stamp = recorded_stamp_ns(record.stamps);
  if (is_timed_by_order()) return void(++faults_.ignored_lines);
  if (!stamp) return note_malformed();
  sensing::CompassReading reading = record.reading;
  reading.stamp_ns = *stamp;
  ready_.emplace_back(std::move(reading));
}

void CarmenLog::take(const ImuRecord& record) {
  const auto stamp = recorded_stamp_ns(record.stamps);
  if (is_timed_by_order()) return void(++faults_.ignored_lines);
  if (!stamp) return note_malformed();
  if (gyro_stamps_.believes(*stamp)) gyro_.add({*stamp, record.yaw_rate_radps});
}

/// Whether odometry that follows tells what it is at a scan, or during its sweep.
bool CarmenLog::waits_for_odometry() const {
  return plan_.odometry_is_late() || plan_.odometry_held_scans > 0 ||
         plan_.odometry_smoothed_over > 0 || waits_for_sweep();
}

/// A scan is complete when its sweep ends.
bool CarmenLog::waits_for_sweep() const {
  return slow_sweep_ns() > 0 && plan_.odometry != OdometrySource::kNone && !is_timed_by_order();
}

std::int64_t CarmenLog::slow_sweep_ns() const {
  const double sweep_s = sweep_s_by_period(plan_.figures);
  return sweep_s < sensing::kSlowSweep_s ? 0 : std::llround(1e9 * sweep_s);
}

/// Returns false unless it is newer than those before.
bool CarmenLog::smooth_and_keep(const sensing::Odometry& odometry) {
  if (plan_.odometry_smoothed_over == 0) return keep_odometry(odometry);
  if (!smoother_) smoother_.emplace(plan_.odometry_smoothed_over);
  if (newest_to_smooth_ns_ && odometry.stamp_ns <= *newest_to_smooth_ns_) return false;
  newest_to_smooth_ns_ = odometry.stamp_ns;
  if (const auto smoothed = smoother_->add(odometry)) keep_odometry(*smoothed);
  return true;
}

/// Whether a scan's pose is not a repeated one. One that is repeated for long is: the vehicle
/// stands.
bool CarmenLog::is_fresh(const geometry::Pose2& wheel_from_base) {
  if (held_pose_ == wheel_from_base && ++held_scans_ <= plan_.odometry_held_scans) return false;
  held_pose_ = wheel_from_base;
  held_scans_ = 0;
  return true;
}

/// Returns false unless it is newer than the lines held back.
bool CarmenLog::keep_odometry(const sensing::Odometry& odometry) {
  if (!odom_lines_.empty() && odometry.stamp_ns <= odom_lines_.back().stamp_ns) return false;
  odom_lines_.push_back(odometry);
  return true;
}

void CarmenLog::note_malformed() {
  ++faults_.malformed_lines;
  last_malformed_line_ = now_.line_number;
  if (faults_.first_malformed_lines.size() < LogFaults::kNamedLines)
    faults_.first_malformed_lines.push_back(now_.line_number);
}

void CarmenLog::finish_reading() {
  is_finished_ = true;
  // A malformed last line without an end was cut.
  const bool last_line_is_broken =
      records_->last_line_is_unfinished() && last_malformed_line_ == records_->line_number();
  faults_.is_cut = records_->is_cut() || last_line_is_broken;
  faults_.damage = records_->damage();
  merge_scans(0);
  while (const auto smoothed = smoother_ ? smoother_->finish() : std::nullopt)
    keep_odometry(*smoothed);
  put_waiting_scans(0);
  if (!survey_) return;
  const LogPlan plan = survey_->conclude(options_.fallback_field_of_view_rad,
                                         {.main = {}, .used = names_of(plan_.scanners)});
  plan_.figures = plan.figures;
  plan_.evidence = plan.evidence;
  plan_.evidence.correction = {};  // earlier returned scans were not corrected
  for (std::size_t i = 0; i < std::min(plan_.scanners.size(), plan.scanners.size()); ++i) {
    plan_.scanners[i].floor = plan.scanners[i].floor;
    plan_.scanners[i].floor.from.clear();
  }
}

std::optional<std::int64_t> CarmenLog::recorded_stamp_ns(const CarmenStamps& stamps) const {
  return plan_.clock == LogClock::kLogger ? stamps.logger_ns : stamps.ipc_ns;
}

/// Replaced stamps are those of the main scanner; another scanner's scan lies between the
/// neighbouring ones of the main scanner.
std::optional<std::int64_t> CarmenLog::scan_stamp_ns(const CarmenStamps& stamps,
                                                     std::size_t scanner) const {
  const std::vector<std::int64_t>& replaced_ns = plan_.times.stamps_ns;
  const bool is_replaced = !replaced_ns.empty() && (scanner == 0 || is_timed_by_order());
  if (!is_replaced) return recorded_stamp_ns(stamps);
  const std::size_t next = scans_[0];
  if (scanner == 0)
    return next < replaced_ns.size() ? std::optional(replaced_ns[next]) : std::nullopt;
  if (next == 0 || next >= replaced_ns.size()) return std::nullopt;
  return replaced_ns[next - 1] + (replaced_ns[next] - replaced_ns[next - 1]) / 2;
}

/// If scan stamps are replaced, ODOM lines are spaced evenly between two scans of the main scanner,
/// in the order of the log. The last line has the stamp of the following scan if that scan has no
/// pose. nullopt if the line is not needed.
std::optional<std::int64_t> CarmenLog::odometry_stamp_by_order_ns() {
  const bool scans_have_poses = plan_.odometry != OdometrySource::kOdomLines;
  const std::size_t scan = scans_[0];
  if (scan >= plan_.odom_lines_before_scan.size()) return std::nullopt;
  const std::uint32_t lines = plan_.odom_lines_before_scan[scan];
  const std::uint32_t line = ++odom_lines_since_scan_;
  const std::int64_t after_ns = plan_.times.stamps_ns[scan];
  if (scan == 0) return line == lines && !scans_have_poses ? std::optional(after_ns) : std::nullopt;
  const std::int64_t before_ns = plan_.times.stamps_ns[scan - 1];
  const double fraction =
      static_cast<double>(line) / static_cast<double>(scans_have_poses ? lines + 1 : lines);
  return before_ns + std::llround(fraction * static_cast<double>(after_ns - before_ns));
}

std::optional<std::int64_t> CarmenLog::odometry_stamp_ns(const CarmenStamps& stamps) {
  const std::size_t line = odometry_lines_++;
  return line < plan_.odometry_stamps_ns.size() ? std::optional(plan_.odometry_stamps_ns[line])
                                                : recorded_stamp_ns(stamps);
}

sensing::LaserScan CarmenLog::scan_of(LaserRecord record, std::size_t scanner,
                                      std::int64_t stamp_ns) const {
  const BeamLayout layout = record.layout.value_or(
      layout_by_convention(record.range_m.size(), options_.fallback_field_of_view_rad));
  const bool is_main = scanner == 0;
  const double max_range_m = is_main ? plan_.max_range_m : scanner_plan(scanner).max_range_m;
  sensing::LaserScan scan;
  scan.stamp_ns = stamp_ns;
  scan.sequence = scans_[scanner];
  scan.scanner.scanner_id =
      has_several_scanners() ? scanner_id_of(record.scanner) : options_.scanner_id;
  scan.scanner.base_from_laser =
      is_main ? plan_.base_from_laser : scanner_plan(scanner).base_from_laser;
  scan.scanner.first_beam_rad = layout.first_beam_rad;
  scan.scanner.beam_step_rad = layout.beam_step_rad;
  const double refuted_m =
      scanner < plan_.scanners.size() ? plan_.scanners[scanner].refuted_max_range_m : 0.0;
  scan.scanner.max_range_m =
      record.max_range_m > refuted_m ? std::min(record.max_range_m, max_range_m) : max_range_m;
  scan.range_m = std::move(record.range_m);
  correct(scan, scanner);
  return scan;
}

/// Corrects beams and ranges as the survey found: unit by log, beams by main scanner.
void CarmenLog::correct(sensing::LaserScan& scan, std::size_t scanner) const {
  const matching::LogCorrection& correction = plan_.evidence.correction;
  if (!plan_.scanners.empty()) {
    scanner_plan(scanner).own_body.hide(scan.range_m, sensing::kTellsNothing);
    scanner_plan(scanner).floor.hide(scan.range_m, sensing::kTellsNothing);
  }
  if (correction.range_unit_m != 1.0) {
    for (float& range_m : scan.range_m) range_m *= static_cast<float>(correction.range_unit_m);
  }
  if (!has_beams_of_the_main_one(scanner)) return;
  scan.scanner.first_beam_rad *= correction.field_factor;
  scan.scanner.beam_step_rad *= correction.field_factor;
  // The record counts as written in reverse order, so that the sweep follows the layout;
  // localization estimates the sense otherwise.
  if (correction.reverses_beams) std::ranges::reverse(scan.range_m);
}

/// CARMEN's records of one kind come from one program; in a bag each scanner has its own driver.
bool CarmenLog::has_beams_of_the_main_one(std::size_t scanner) const {
  return scanner == 0 ||
         (scanner_plan(scanner).kind == plan_.laser && plan_.laser != LaserRecordKind::kBag);
}

void CarmenLog::put_odometry(const sensing::Odometry& odometry) {
  newest_odometry_ = odometry;
  ready_.emplace_back(odometry);
}

/// Returns the held-back ODOM lines up to this time that are newer than the last returned one.
void CarmenLog::put_odometry_until(std::int64_t stamp_ns) {
  for (; !odom_lines_.empty() && odom_lines_.front().stamp_ns <= stamp_ns;
       odom_lines_.pop_front()) {
    if (newest_odometry_ && odom_lines_.front().stamp_ns <= newest_odometry_->stamp_ns) {
      ++faults_.stale_odometry;
    } else {
      put_odometry(odom_lines_.front());
    }
  }
}

void CarmenLog::put_waiting_scans(std::size_t may_wait) {
  const std::int64_t sweep_ns = waits_for_sweep() ? slow_sweep_ns() : 0;
  while (!waiting_.empty()) {
    const bool has_odometry =
        !odom_lines_.empty() &&
        odom_lines_.back().stamp_ns >= waiting_.front().stamp_ns + sweep_ns &&
        (odom_lines_.size() > 1 || !is_long_before_odometry(waiting_.front().stamp_ns));
    if (!has_odometry && waiting_.size() <= may_wait) return;
    sensing::LaserScan scan = std::move(waiting_.front());
    waiting_.pop_front();
    const std::int64_t stamp = scan.stamp_ns;
    put_odometry_until(stamp - 1);
    const auto wheel_from_base = wheel_from_base_at(stamp);
    put_pose_at(stamp, wheel_from_base);
    const bool was_its_own = !odom_lines_.empty() && odom_lines_.front().stamp_ns == stamp &&
                             newest_odometry_ && newest_odometry_->stamp_ns == stamp;
    if (was_its_own) odom_lines_.pop_front();
    if (sweep_ns > 0) put_odometry_through(stamp + sweep_ns);
    put_scan(std::move(scan));
  }
}

/// That up to this time, and the first one after it.
void CarmenLog::put_odometry_through(std::int64_t stamp_ns) {
  put_odometry_until(stamp_ns - 1);
  if (!odom_lines_.empty()) put_odometry_until(odom_lines_.front().stamp_ns);
}

bool CarmenLog::is_long_before_odometry(std::int64_t stamp_ns) const {
  constexpr std::int64_t kLongNs = 50'000'000;
  return !newest_odometry_ && !odom_lines_.empty() &&
         odom_lines_.front().stamp_ns - stamp_ns > kLongNs;
}

/// Interpolates between the last returned line and the first held-back one; uses the nearer one if
/// only one exists. A vehicle that drives before the first line did so as it does after it.
std::optional<geometry::Pose2> CarmenLog::wheel_from_base_at(std::int64_t stamp_ns) const {
  const bool is_over = plan_.odometry_is_late();  // no pose is known after the last late one
  if (odom_lines_.empty())
    return newest_odometry_ && !is_over ? std::optional(newest_odometry_->wheel_from_base)
                                        : std::nullopt;
  const sensing::Odometry& after = odom_lines_.front();
  if (is_long_before_odometry(stamp_ns)) {
    constexpr double kFarthestBack_ns = 3e8;
    const auto before_ns = static_cast<double>(after.stamp_ns - stamp_ns);
    if (odom_lines_.size() < 2 || before_ns > kFarthestBack_ns) return std::nullopt;
    const sensing::Odometry& next = odom_lines_[1];
    return geometry::interpolate(
        next.wheel_from_base, after.wheel_from_base,
        1.0 + before_ns / static_cast<double>(next.stamp_ns - after.stamp_ns));
  }
  if (!newest_odometry_ || after.stamp_ns <= newest_odometry_->stamp_ns ||
      after.stamp_ns == stamp_ns)
    return after.wheel_from_base;
  const double fraction = static_cast<double>(stamp_ns - newest_odometry_->stamp_ns) /
                          static_cast<double>(after.stamp_ns - newest_odometry_->stamp_ns);
  return geometry::interpolate(newest_odometry_->wheel_from_base, after.wheel_from_base,
                               std::clamp(fraction, 0.0, 1.0));
}

/// Odometry at a scan's stamp.
void CarmenLog::put_pose_at(std::int64_t stamp_ns,
                            const std::optional<geometry::Pose2>& wheel_from_base) {
  if (scan_stamps_.believes(stamp_ns) && wheel_from_base &&
      (!newest_odometry_ || stamp_ns > newest_odometry_->stamp_ns))
    put_odometry({stamp_ns, *wheel_from_base});
}

void CarmenLog::put_scan(sensing::LaserScan scan) {
  if (first_scan_)
    std::swap(first_scan_->sequence, scan.sequence);  // sequences follow the order of return
  ready_.emplace_back(std::move(scan));
  if (first_scan_) ready_.emplace_back(*std::exchange(first_scan_, std::nullopt));
}

}  // namespace slammot::files
