#include "services/ingest/ingest_service.hpp"

#include <algorithm>

#include <CLI/CLI.hpp>

#include "common/app/log.hpp"
#include "common/wire/text.hpp"
#include "services/ingest/ingest_fields.hpp"
#include "services/ingest/topic_arguments.hpp"

namespace slammot::ingest {
namespace {

using std::chrono::steady_clock;

/// Time at the end for readers that have not received the last scan.
constexpr std::chrono::seconds kAcknowledgementTime{1};

/// Of each scanner, at a given speed: as many localized scans as a reader keeps.
constexpr std::size_t kMostInFlight = 4;

std::chrono::nanoseconds nanoseconds_of(double seconds) {
  return std::chrono::nanoseconds(static_cast<std::int64_t>(seconds * 1e9));
}

LogSource open_source(const IngestService::Settings& settings) {
  if (settings.input.empty()) throw app::StartupFailure("--input FILE is required");
  auto source = LogSource::open(settings.input, settings.config, settings.topics);
  if (!source) throw app::StartupFailure(source.error().message);
  return std::move(*source);
}

app::Pace parse_pace(const std::string& speed) {
  const auto pace = app::Pace::parse(speed);
  if (!pace) throw app::StartupFailure("--speed " + speed + ": not " + app::Pace::kExpected);
  return *pace;
}

std::filesystem::path mark_path(const app::ServiceOptions& options) {
  return app::state_path(options, "ingest", app::StateOf::kInstance, ".drive");
}

/// One line that identifies a log.
std::string describe(const std::filesystem::path& input, const files::LogFigures& figures) {
  return input.filename().string() + " " + std::to_string(figures.scans) + " scans " +
         std::to_string(figures.duration_s) + " s " + std::to_string(figures.distance_m) + " m";
}

std::uint64_t new_drive_id() {
  return static_cast<std::uint64_t>(std::chrono::system_clock::now().time_since_epoch().count());
}

}  // namespace

std::vector<config::BoundStage> IngestService::stages(Settings& settings) {
  return {config::bind_stage("ingest", ingest_fields(), settings.config)};
}

void IngestService::add_options(CLI::App& command_line, Settings& settings) {
  command_line.add_option("--input", settings.input,
                          "CARMEN or DP-SLAM log, plain or .gz, or a ROS bag");
  add_topic_options(command_line, settings.topics);
  app::add_speed_option(
      command_line, settings.speed,
      "Multiple of the recorded speed, or 'max': as fast as the other services answer");
  command_line.add_flag(
      "--forgive-cut", settings.forgive_cut,
      "Exit code 0 for a truncated log, for supervisors that restart failed processes");
  command_line.add_flag("--linger", settings.linger, "Stay after the end of the log until stopped");
}

IngestService::IngestService(app::ServiceContext& context, const Settings& settings)
    : context_(context),
      config_(settings.config),
      linger_(settings.linger),
      forgive_cut_(settings.forgive_cut),
      source_(open_source(settings)),
      scanner_ids_(source_.log().scanner_ids()),
      drive_(mark_path(context.options()), describe(settings.input, source_.log().plan().figures),
             new_drive_id()),
      pace_(parse_pace(settings.speed)),
      backlog_({.most_in_flight = kMostInFlight * scanner_ids_.size()}),
      window_(
          {static_cast<std::size_t>(config_.window_scans), nanoseconds_of(config_.resend_after_s)}),
      graph_(nanoseconds_of(config_.graph_patience_s)),
      scans_(context.write(dds::topics::kLaserScan)),
      odometry_(context.write(dds::topics::kOdometry)),
      fixes_(context.write(dds::topics::kGnssFix)),
      headings_(context.write(dds::topics::kCompassReading)),
      encoder_(drive_.drive_id()),
      give_up_waiting_at_(steady_clock::now() + nanoseconds_of(config_.wait_for_services_s)) {
  context.status().counter("log_finished") = 0;
  context.status().counter("log_scans") = source_.log().plan().figures.scans;
  context.read(
      dds::topics::kHeartbeat, app::Input::kOccasional, [this](const slammot_Heartbeat& beat) {
        if (app::take(beat, readiness_))
          give_up_waiting_at_ = steady_clock::now() + nanoseconds_of(config_.wait_for_services_s);
        if (wire::text(beat.service_name) == "loop_closing") graph_.heard(steady_clock::now());
      });
  context.read(dds::topics::kScanLabels, app::Input::kOccasional,
               [this](const auto& labels) { take_labels(labels); });
  context.read(dds::topics::kLocalizedScan, app::Input::kOccasional,
               [this](const auto& scan) { take_localized(scan); });
  if (pace_.is_unlimited()) watch_graph();
  context.on_command("set_speed", [this](std::string_view speed) { return set_speed(speed); });
  context.every(std::chrono::milliseconds(50),
                [this] { has_begun_ ? check_progress() : wait_for_services(); });
}

bool IngestService::is_own(std::string_view scanner_id) const {
  return std::ranges::find(scanner_ids_, scanner_id) != scanner_ids_.end();
}

void IngestService::take_localized(const slammot_LocalizedScan& scan) {
  const auto now = steady_clock::now();
  if (pace_.is_unlimited()) return graph_.set_current({scan.map_id}, scan.submap_id, now);
  if (!is_own(wire::text(scan.scanner_id))) return;
  backlog_.answered(Backlog::Answer::kLocalized, scan.stamp_ns, now);
  if (has_begun_ && !has_finished_) send_backlog();
}

void IngestService::watch_graph() {
  context_.read(dds::topics::kGraphCorrection, app::Input::kOccasional,
                [this](const slammot_GraphCorrection& part) {
                  if (part.part_index + 1 != part.part_count || part.submaps._length == 0) return;
                  graph_.set_placed({part.map_id},
                                    part.submaps._buffer[part.submaps._length - 1].submap_id);
                  if (has_begun_ && !has_finished_) proceed_at_max_speed();
                });
}

void IngestService::wait_for_services() {
  const bool is_patient = steady_clock::now() < give_up_waiting_at_;
  if (app::may_begin(context_, readiness_, scans_.topic().name, scans_.matched_readers() != 0,
                     is_patient))
    begin();
}

void IngestService::begin() {
  has_begun_ = true;
  app::log_info("plays {} scans", source_.log().plan().figures.scans);
  proceed();
}

void IngestService::proceed() { pace_.is_unlimited() ? proceed_at_max_speed() : proceed_at_pace(); }

/// Takes what is due, but not so much at once that answers would have to wait.
void IngestService::proceed_at_pace() {
  constexpr int kMostInATurn = 16;
  auto wait = steady_clock::duration::zero();
  for (int i = 0; i < kMostInATurn && fetch(); ++i) {
    const auto now = steady_clock::now();
    if (fetched_->scan) wait = pace_.due(fetched_->scan->stamp_ns, now) - now;
    if (wait > wait.zero()) break;
    backlog_.add(*std::exchange(fetched_, std::nullopt), now);
  }
  send_backlog();
  if (has_finished_ || !fetch() || std::exchange(is_timer_set_, true)) return;
  context_.after(std::max(wait, wait.zero()), [this] {
    is_timer_set_ = false;
    proceed_at_pace();
  });
}

void IngestService::send_backlog() {
  const auto now = steady_clock::now();
  context_.status().counter("dropped_scans") += backlog_.drop_late();
  while (backlog_.may_send(now)) send_once(backlog_.take(now));
  if (backlog_.empty() && !fetch()) finish();
}

app::CommandResult IngestService::set_speed(std::string_view speed) {
  const auto pace = app::Pace::parse(std::string(speed));
  if (!pace || pace->is_unlimited() || pace_.is_unlimited())
    return {app::CommandOutcome::kRefused,
            "only from one multiple of the recorded speed to another"};
  pace_ = *pace;
  return {app::CommandOutcome::kDone, std::string(speed)};
}

void IngestService::proceed_at_max_speed() {
  while (window_.has_room()) {
    if (graph_.is_behind(steady_clock::now())) return;
    if (!fetch()) break;
    if (fetched_->scan) {
      window_.sent(fetched_->scan->stamp_ns, steady_clock::now());
      in_flight_.push_back(*fetched_);
    }
    send_once(*std::exchange(fetched_, std::nullopt));
  }
  if (window_.is_empty()) finish();
  else fetch();  // while the services are busy with the scans before
}

/// Several scanners may share a stamp.
bool IngestService::is_acknowledged(const sensing::LaserScan& scan) const {
  if (!acknowledged_ns_ || scan.stamp_ns > *acknowledged_ns_) return false;
  return scan.stamp_ns < *acknowledged_ns_ ||
         acknowledged_scanners_.contains(scan.scanner.scanner_id);
}

/// Makes fetched_ the next unprocessed step; false at the end of the log. After a restart this
/// skips the scans that the previous process has sent: the first answer names the latest of them.
bool IngestService::fetch() {
  // Localization answers neither a scan without beams nor a blank one before it has a pose.
  const auto is_blank = [&] {
    if (!fetched_->scan) return false;
    return fetched_->scan->range_m.empty() ||
           (!has_sent_scan_ &&
            sensing::is_blank(*fetched_->scan, source_.log().plan().figures.scan_period_s));
  };
  while (!fetched_ || is_blank() || (fetched_->scan && is_acknowledged(*fetched_->scan))) {
    if (fetched_) ++context_.status().counter(is_blank() ? "blank_scans" : "skipped_scans");
    fetched_ = source_.next();
    if (!fetched_) return false;
  }
  return true;
}

void IngestService::send_once(const Step& step) {
  send(step);
  if (!step.scan) return;
  ++context_.status().counter("scans");
  has_sent_scan_ = true;
}

void IngestService::send(const Step& step) {
  const auto count_timeout = [this](dds::WriteResult result) {
    if (result == dds::WriteResult::kTimedOut)
      context_.warn("slow_readers", "a sample was not sent: a reader is slow");
  };
  for (const sensing::Odometry& odometry : step.odometry)
    count_timeout(odometry_.write(wire::encode(context_.vehicle_id(), odometry)));
  for (const sensing::GnssFix& fix : step.fixes)
    count_timeout(fixes_.write(wire::encode(context_.vehicle_id(), fix)));
  for (const sensing::CompassReading& reading : step.headings)
    count_timeout(headings_.write(wire::encode(context_.vehicle_id(), reading)));
  if (step.scan) count_timeout(scans_.write(encoder_.encode(context_.vehicle_id(), *step.scan)));
}

void IngestService::take_labels(const slammot_ScanLabels& labels) {
  const std::string scanner_id(wire::text(labels.scanner_id));
  if (!is_own(scanner_id)) return;
  const bool is_ahead = fetched_ && fetched_->scan && labels.stamp_ns >= fetched_->scan->stamp_ns;
  if (!acknowledged_ns_ || labels.stamp_ns > *acknowledged_ns_) {
    acknowledged_ns_ = labels.stamp_ns;
    acknowledged_scanners_.clear();
  }
  if (labels.stamp_ns == *acknowledged_ns_) acknowledged_scanners_.insert(scanner_id);
  backlog_.answered(Backlog::Answer::kLabelled, labels.stamp_ns, steady_clock::now());
  const std::size_t done = window_.acknowledge(labels.stamp_ns, steady_clock::now());
  in_flight_.erase(in_flight_.begin(), in_flight_.begin() + static_cast<std::ptrdiff_t>(done));
  if (!has_begun_ || has_finished_) return;
  if (pace_.is_unlimited()) {
    if (done > 0) proceed_at_max_speed();
    return;
  }
  if (is_ahead) pace_.restart();  // the pending timer sends the next scan
  send_backlog();
}

void IngestService::check_progress() {
  const auto now = steady_clock::now();
  if (has_finished_) return;
  if (!pace_.is_unlimited()) return send_backlog();
  if (window_.has_room()) proceed_at_max_speed();  // the wait for the graph may have timed out
  if (has_finished_ || !window_.is_overdue(now)) return;
  const std::size_t given_up = window_.resend(now);
  for (std::size_t i = 0; i < given_up; ++i) {
    context_.warn("given_up_scans",
                  "no answer to scan " + std::to_string(in_flight_.front().scan->sequence));
    in_flight_.pop_front();
  }
  if (!in_flight_.empty())
    context_.warn("resent_scans", "no labels in time: sends pending scans again");
  for (const Step& step : in_flight_) send(step);
  proceed_at_max_speed();
}

void IngestService::finish() {
  if (has_finished_) return;
  has_finished_ = true;
  const files::LogFaults& faults = source_.log().faults();
  auto& status = context_.status();
  status.counter("malformed_lines") = faults.malformed_lines;
  status.counter("log_is_cut") = faults.is_cut ? 1 : 0;
  status.counter("log_finished") = 1;
  if (faults.is_cut) app::log_warn("the log is truncated; the readable part was played");
  app::log_info("finished {} scans", status.counter("scans"));
  if (linger_) return;
  scans_.wait_for_acknowledgements(kAcknowledgementTime);
  context_.stop(faults.is_cut && !forgive_cut_ ? kExitCut : 0);
}

}  // namespace slammot::ingest
