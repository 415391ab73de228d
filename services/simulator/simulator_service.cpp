#include "services/simulator/simulator_service.hpp"

#include <algorithm>
#include <cmath>

#include <CLI/CLI.hpp>

#include "common/app/log.hpp"
#include "common/files/number_option.hpp"
#include "common/wire/text.hpp"
#include "services/simulator/scenario_files.hpp"

namespace slammot::simulator {
namespace {

using std::chrono::steady_clock;

constexpr std::chrono::seconds kAcknowledgementTime{1};  ///< Time at the end for readers that have
                                                         ///< not received everything.
constexpr std::chrono::seconds kAnswerTimeout{1};        ///< At speed max.

constexpr std::uint64_t kScansOfANote = 20;  ///< After so many the progress is noted.

simulation::ScenarioConfig scenario_of(const SimulatorService::Settings& settings) {
  if (settings.scenario.empty()) throw app::StartupFailure("--scenario NAME is required");
  auto scenario = load_scenario(settings.scenario, settings.seed);
  if (!scenario) throw app::StartupFailure(scenario.error().message);
  if (settings.ride > 0) scenario->ride = settings.ride;
  for (std::size_t i = 0; i <= scenario->more_scanners.size(); ++i) {
    if (scenario->scanner_at(i).beams > static_cast<int>(wire::kMostBeams))
      throw app::StartupFailure("a scanner has more beams than a message holds");
  }
  return std::move(*scenario);
}

app::Pace parse_pace(const std::string& speed) {
  const auto pace = app::Pace::parse(speed);
  if (!pace) throw app::StartupFailure("--speed " + speed + ": not " + app::Pace::kExpected);
  return *pace;
}

/// One line that identifies a drive: the same settings simulate the same one.
std::string describe(const SimulatorService::Settings& settings) {
  return settings.scenario + " seed " + (settings.seed ? std::to_string(*settings.seed) : "own") +
         " ride " + std::to_string(settings.ride);
}

std::uint64_t new_drive_id() {
  return static_cast<std::uint64_t>(std::chrono::system_clock::now().time_since_epoch().count());
}

}  // namespace

void SimulatorService::add_options(CLI::App& command_line, Settings& settings) {
  command_line.add_option("--scenario", settings.scenario,
                          "Name (slammot simulate --list) or file");
  command_line
      .add_option("--seed", settings.seed,
                  "Seed of world, traffic and noise; default: the scenario's own")
      ->check(files::not_negative_number());
  command_line
      .add_option("--ride", settings.ride,
                  "Index of the scenario's vehicle with scanners; 0: the first")
      ->check(CLI::Range(0, 100));
  app::add_speed_option(
      command_line, settings.speed,
      "Multiple of the simulated clock, or 'max': as fast as the other services answer");
  command_line
      .add_option("--wait-for-services", settings.wait_for_services_s,
                  "Longest time to wait for other services before the first scan [s]")
      ->capture_default_str()
      ->check(files::number_between(0.0, 3600.0));
  command_line.add_flag("--linger", settings.linger,
                        "Stay after the end of the drive until stopped");
}

SimulatorService::SimulatorService(app::ServiceContext& context, const Settings& settings)
    : context_(context),
      pace_(parse_pace(settings.speed)),
      linger_(settings.linger),
      patience_(std::llround(1e3 * settings.wait_for_services_s)),
      give_up_waiting_at_(steady_clock::now() + patience_),
      drive_(scenario_of(settings)),
      mark_(app::state_path(context.options(), "simulator", app::StateOf::kInstance, ".drive"),
            describe(settings), new_drive_id()),
      scans_(context.write(dds::topics::kLaserScan)),
      odometry_(context.write(dds::topics::kOdometry)),
      fixes_(context.write(dds::topics::kGnssFix)),
      compass_readings_(context.write(dds::topics::kCompassReading)),
      true_poses_(context.write(dds::topics::kTruePose)),
      true_objects_(context.write(dds::topics::kTrueObjects)),
      true_hits_(context.write(dds::topics::kTrueHits)) {
  encoder_ = wire::LaserScanEncoder(mark_.drive_id());
  truth_ = wire::TruthEncoder(mark_.drive_id());
  context.status().counter("log_finished") = 0;
  context.status().counter("log_scans") = drive_.scan_count();
  context.read(dds::topics::kHeartbeat, app::Input::kOccasional,
               [this](const slammot_Heartbeat& beat) {
                 if (app::take(beat, readiness_))
                   give_up_waiting_at_ = steady_clock::now() + patience_;
               });
  context.read(dds::topics::kScanLabels, app::Input::kOccasional,
               [this](const auto& labels) { take_labels(labels); });
  context.every(std::chrono::milliseconds(50),
                [this] { has_begun_ ? check_progress() : wait_for_services(); });
}

void SimulatorService::wait_for_services() {
  const bool is_patient = steady_clock::now() < give_up_waiting_at_;
  if (app::may_begin(context_, readiness_, scans_.topic().name, scans_.matched_readers() != 0,
                     is_patient))
    begin();
}

/// With the turns of the gyro, if the vehicle has one. Vertical profiles are left out: no service
/// uses them.
std::optional<simulation::SimulatedScan> SimulatorService::next_scan() {
  auto scan = drive_.next();
  while (scan && scan->is_vertical) scan = drive_.next();
  if (!scan) return scan;
  for (const sensing::TurnRate& reading : scan->turn_rates) gyro_.add(reading);
  scan->odometry = gyro_.fused(scan->odometry);
  return scan;
}

void SimulatorService::begin() {
  has_begun_ = true;
  app::log_info("begins a drive of {} scans", drive_.scan_count());
  next_ = next_scan();
  skip_what_was_sent();
  schedule();
}

/// By the process before, if it was killed: the drive goes on. The last second may be sent again.
void SimulatorService::skip_what_was_sent() {
  if (!mark_.noted_ns()) return;
  while (next_ && next_->scan.stamp_ns <= *mark_.noted_ns()) {
    if (next_->scanner == 0) ++context_.status().counter("scans");
    next_ = next_scan();
  }
  ++context_.status().counter("continued_drives");
  app::log_info("continues the drive after {} scans", context_.status().counter("scans"));
}

/// Sends the next scan when it is due, after pending events of the service.
void SimulatorService::schedule() {
  if (!next_) return finish();
  const auto now = steady_clock::now();
  const auto due = pace_.is_unlimited() ? now : pace_.due(next_->scan.stamp_ns, now);
  context_.after(std::max(due - now, steady_clock::duration::zero()), [this] { send_next(); });
}

void SimulatorService::send_next() {
  send(*next_);
  const bool waits_for_answer = pace_.is_unlimited() && next_->scanner == 0;
  if (waits_for_answer) {
    unanswered_ns_ = next_->scan.stamp_ns;
    unanswered_since_ = steady_clock::now();
  }
  next_ = next_scan();
  if (!waits_for_answer) schedule();
}

void SimulatorService::send(const simulation::SimulatedScan& drive) {
  const auto count_timeout = [this](dds::WriteResult result) {
    if (result == dds::WriteResult::kTimedOut)
      context_.warn("slow_readers", "a sample was not sent: a reader is slow");
  };
  const std::string& vehicle = context_.vehicle_id();
  for (const sensing::GnssFix& fix : drive.gnss)
    count_timeout(fixes_.write(wire::encode(vehicle, fix)));
  for (const sensing::CompassReading& reading : drive.compass)
    count_timeout(compass_readings_.write(wire::encode(vehicle, reading)));
  count_timeout(odometry_.write(wire::encode(vehicle, drive.odometry)));
  count_timeout(scans_.write(encoder_.encode(vehicle, drive.scan)));
  if (drive.scanner == 0) count_timeout(true_poses_.write(truth_.encode_pose(vehicle, drive)));
  count_timeout(true_objects_.write(truth_.encode_objects(vehicle, drive)));
  count_timeout(true_hits_.write(truth_.encode_hits(vehicle, drive)));
  if (drive.scanner == 0 && ++context_.status().counter("scans") % kScansOfANote == 0)
    mark_.note(drive.scan.stamp_ns);
}

void SimulatorService::take_labels(const slammot_ScanLabels& labels) {
  if (!unanswered_ns_ || labels.stamp_ns < *unanswered_ns_) return;
  unanswered_ns_.reset();
  schedule();
}

void SimulatorService::check_progress() {
  if (!unanswered_ns_ || steady_clock::now() - unanswered_since_ < kAnswerTimeout) return;
  context_.warn("unanswered_scans", "no labels in time: continues");
  unanswered_ns_.reset();
  schedule();
}

void SimulatorService::finish() {
  if (has_finished_) return;
  has_finished_ = true;
  context_.status().counter("log_finished") = 1;
  app::log_info("finished {} scans", context_.status().counter("scans"));
  if (linger_) return;
  scans_.wait_for_acknowledgements(kAcknowledgementTime);
  true_hits_.wait_for_acknowledgements(kAcknowledgementTime);
  context_.stop(0);
}

}  // namespace slammot::simulator
