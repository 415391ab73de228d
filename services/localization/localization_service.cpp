#include "services/localization/localization_service.hpp"

#include <cmath>
#include <utility>

#include <malloc.h>

#include <CLI/CLI.hpp>

#include "common/app/log.hpp"
#include "common/files/number_option.hpp"
#include "common/wire/scan_labels.hpp"
#include "common/wire/segmented_scan.hpp"
#include "common/wire/sensor.hpp"
#include "common/wire/tracked_objects.hpp"
#include "services/localization/localization_fields.hpp"
#include "services/localization/localization_service_clock.hpp"

namespace slammot::localization {
namespace {

using namespace std::chrono_literals;

/// Turn of the loop, at least.
constexpr auto kTurn = 10ms;

LocalizerConfig config_of(const LocalizationService::Settings& settings) {
  LocalizerConfig config = settings.config;
  config.odometry.watches_lateness = !settings.log_is_examined;
  config.odometry.watches_factors = !settings.log_is_examined;
  return config;
}

std::filesystem::path checkpoint_path(const app::ServiceOptions& options) {
  return app::state_path(options, "localization", app::StateOf::kVehicle, ".checkpoint");
}

}  // namespace

std::vector<config::BoundStage> LocalizationService::stages(Settings& settings) {
  return {config::bind_stage("localization", localization_fields(), settings.config)};
}

void LocalizationService::add_options(CLI::App& command_line, Settings& settings) {
  command_line.add_flag("--continue-map", settings.continues_map,
                        "Go on in the map that map_store has, beginning anywhere in it");
  command_line
      .add_option(
          "--map-patience", settings.map_patience_s,
          "With --continue-map: without news of that map for so long [s], a drive begins its own")
      ->capture_default_str()
      ->check(files::number_between(0.1, 3600.0));
  command_line.add_flag("--examined-log", settings.log_is_examined,
                        "The scans are of a log that ingest has examined as a whole: lateness of "
                        "odometry is not looked for while driving");
  command_line
      .add_option("--drive-id", settings.drive_ids,
                  "Ids of its drives, in their order, in place of the clock's: to repeat a drive")
      ->check(files::not_negative_number())
      ->type_name("ID");
}

LocalizationService::LocalizationService(app::ServiceContext& context, const Settings& settings)
    : context_(context),
      config_(config_of(settings)),
      localizer_(config_),
      scans_(context),
      submaps_(context),
      checkpoint_(checkpoint_path(context.options())) {
  if (settings.continues_map) {
    drives_.stored_map.emplace(std::llround(settings.map_patience_s * 1e9), config_.map.cell_size_m,
                               monotonic_ns());
    is_stored_map_known();  // so that nobody takes it for ready before the first turn
  }
  drives_.ids.assign(settings.drive_ids.begin(), settings.drive_ids.end());
  read_inputs(context);
  context.stop_between_scans();
  context.every(kTurn, [this] {
    waiting_.count_turn();
    admit(drives_.gate.judge_held(monotonic_ns()));
    if (drives_.stored_map && !drive_.map_id) is_stored_map_known();
    localize_waiting();
  });
  context.before_report([this] { context_.status().set_counters(named(localizer_.counters())); });
  context.on_command("finish_submap", [this](std::string_view) { return finish_submap(); });
}

void LocalizationService::prepare(app::ServiceContext& context) {
  context.prepare(dds::topics::kTrackedObjects, dds::History::kRestart);
  context.prepare(dds::topics::kScanLabels, dds::History::kRestart);
  context.prepare(dds::topics::kOdometry, dds::History::kRestart);
  context.prepare(dds::topics::kLaserScan, dds::History::kRestart);
  context.prepare_to_write(dds::topics::kLocalizedScan);
}

void LocalizationService::rehearse(app::ServiceContext& context, const Settings& settings) {
  constexpr int kKept_bytes = 1 << 28;
  constexpr int kLargestOfHeap_bytes = 1 << 25;  // what is larger is given back when it is freed
  ::mallopt(M_TRIM_THRESHOLD, kKept_bytes);
  ::mallopt(M_MMAP_THRESHOLD, kLargestOfHeap_bytes);
  Localizer localizer(config_of(settings));
  if (const auto saved = SessionFile(checkpoint_path(context.options())).read())
    localizer.restore(saved->session.localizer);
}

LocalizationService::~LocalizationService() {
  if (drive_.last_done_ns) checkpoint_.save_last(*drive_.last_done_ns, session(), localizer_);
}

void LocalizationService::read_inputs(app::ServiceContext& context) {
  using app::Input;
  // In this order also when several wait: what is known about earlier scans goes into the map
  // before the next is matched.
  context.read(dds::topics::kStoredMap, Input::kOccasional,
               [this](const auto& sample) { take(sample); });
  context.read(dds::topics::kGraphCorrection, Input::kOccasional,
               [this](const auto& sample) { take(sample); });
  // All answers to scans, also where several are localized in a turn.
  const auto take_sample = [this](const auto& sample) { take(sample); };
  using dds::History;
  context.read(dds::topics::kSegmentedScan, Input::kSteady, take_sample, History::kRecorder);
  context.read(dds::topics::kTrackedObjects, Input::kSteady, take_sample, History::kRestart);
  context.read(dds::topics::kScanLabels, Input::kSteady, take_sample, History::kRestart);
  context.read(dds::topics::kOdometry, Input::kSteady, take_sample, History::kRestart);
  context.read(dds::topics::kGnssFix, Input::kOccasional,
               [this](const auto& sample) { take(sample); });
  context.read(dds::topics::kCompassReading, Input::kOccasional,
               [this](const auto& sample) { take(sample); });
  context.read(
      dds::topics::kLaserScan, Input::kSteady,
      [this](const slammot_LaserScan& sample, const dds::SampleInfo& info) { take(sample, info); },
      History::kRestart);
}

template <typename Value>
bool LocalizationService::is_good(const wire::Decoded<Value>& decoded, std::string_view topic) {
  if (!decoded)
    context_.warn("faulty_" + std::string(topic),
                  "dropped a " + std::string(topic) + ": " + std::string(decoded.fault()));
  return static_cast<bool>(decoded);
}

void LocalizationService::take(const slammot_LaserScan& sample, const dds::SampleInfo& info) {
  auto scan = wire::decode(sample);
  if (!is_good(scan, "laser_scan")) return;
  admit(
      drives_.gate.judge({std::move(*scan), sample.drive_id, info.source_time_ns}, monotonic_ns()));
  localize_waiting();
}

void LocalizationService::take(const slammot_Odometry& sample) {
  if (!config_.odometry.use_odometry) return;  // nor is it waited for
  const auto odometry = wire::decode(sample);
  if (!is_good(odometry, "odometry")) return;
  waiting_.note_odometry();
  localizer_.add_odometry(*odometry);
  recent_odometry_.add(*odometry);
  localize_waiting();
}

void LocalizationService::take(const slammot_GnssFix& sample) {
  const auto fix = wire::decode(sample);
  if (is_good(fix, "gnss_fix")) localizer_.add_fix(*fix);
}

void LocalizationService::take(const slammot_CompassReading& sample) {
  const auto reading = wire::decode(sample);
  if (is_good(reading, "compass_reading")) localizer_.add_heading(*reading);
}

void LocalizationService::take(const slammot_SegmentedScan& sample) {
  const auto segmented = wire::decode(sample);
  if (is_good(segmented, "segmented_scan")) localizer_.note(*segmented);
}

void LocalizationService::take(const slammot_TrackedObjects& sample) {
  const auto objects = wire::decode(sample);
  if (!is_good(objects, "tracked_objects")) return;
  if (is_early(objects->stamp_ns)) return drive_.answers.add(std::move(*objects));
  expect(*objects);
  localize_waiting();
}

void LocalizationService::take(const slammot_ScanLabels& sample) {
  const auto labels = wire::decode(sample);
  if (!is_good(labels, "scan_labels")) return;
  if (is_early(labels->stamp_ns)) {
    drive_.answers.add(std::move(*labels));
    return localize_waiting();
  }
  integrate(*labels);
  context_.note_since_scan("scan_to_map", sample.scan_published_ns);
  localize_waiting();
  if (!drive_.last_done_ns || localizer_.awaits_labels()) return;
  const bool stops = waiting_.empty() && context_.may_stop_now();
  if (!stops) save_checkpoint(*drive_.last_done_ns);
}

bool LocalizationService::is_early(std::int64_t stamp_ns) const {
  return !drive_.last_done_ns || stamp_ns > *drive_.last_done_ns;
}

void LocalizationService::expect(const flow::TrackedObjects& objects) {
  localizer_.expect(objects);
  waiting_.note_objects(objects.stamp_ns, localizer_.awaits_labels());
}

void LocalizationService::integrate(const flow::ScanLabels& labels) {
  const app::Stopwatch stopwatch(context_.status().latency("integrate"));
  localizer_.integrate(labels);
  waiting_.note_labels(labels.stamp_ns, localizer_.awaits_labels());
  publish_finished_submaps();
}

/// In the order in which tracking publishes them.
void LocalizationService::use_early_answers(const sensing::LaserScan& scan) {
  if (const auto objects = drive_.answers.take_objects(scan.stamp_ns)) expect(*objects);
  const auto labels = drive_.answers.take_labels(scan.stamp_ns, scan.scanner.scanner_id);
  if (labels) integrate(*labels);
  else if (waiting_.empty()) drive_.is_back = false;
}

void LocalizationService::take(const slammot_GraphCorrection& sample) {
  auto added = corrections_.assembler.add(sample);
  if (!added.fault.empty())
    context_.warn("faulty_graph_correction",
                  "dropped a graph correction: " + std::string(added.fault));
  if (!added.correction) return;
  if (drives_.stored_map) drives_.stored_map->is_placed(*added.correction, monotonic_ns());
  if (!drive_.map_id) corrections_.early[added.correction->map_id] = std::move(*added.correction);
  else if (added.correction->map_id == *drive_.map_id) correct(*added.correction);
}

void LocalizationService::take(const slammot_StoredMap& sample) {
  const auto stored = wire::decode(sample);
  if (!is_good(stored, "stored_map")) return;
  if (stored->map_id == drive_.map_id) submaps_.release(*stored);
  if (!drives_.stored_map) return;
  drives_.stored_map->is_stored(*stored, monotonic_ns());
  localize_waiting();
}

/// Of the oldest waiting scan.
Awaited LocalizationService::awaited() const {
  const std::int64_t stamp_ns = waiting_.oldest().scan.stamp_ns;
  return {localizer_.has_odometry_for(stamp_ns), localizer_.awaits_labels(),
          !drive_.map_id.has_value(), drive_.is_back,
          drive_.is_back && !drive_.answers.reach(stamp_ns)};
}

void LocalizationService::localize_waiting() {
  while (!waiting_.empty() && waiting_.may_begin(awaited()) && knows_map_of(waiting_.oldest())) {
    const WaitingScan waiting = waiting_.take(awaited());
    if (is_of_this_drive(waiting)) localize(waiting);
  }
}

void LocalizationService::localize(const WaitingScan& waiting) {
  const sensing::LaserScan& scan = waiting.scan;
  if (drive_.last_done_ns) save_checkpoint(*drive_.last_done_ns);
  const app::Stopwatch stopwatch(context_.status().latency("localize"));
  const bool was_lost = localizer_.is_lost();
  const std::uint64_t astray_before = localizer_.counters().map.astray;
  const std::uint64_t retimed_before = localizer_.counters().odometry.retimed;
  const std::uint64_t recalibrated_before = localizer_.counters().odometry.recalibrations;
  auto localized = localizer_.localize(scan);
  tell_whereabouts(was_lost, astray_before);
  tell_of_lateness(retimed_before);
  tell_of_factors(recalibrated_before);
  tell_of_floor(scan.scanner.scanner_id);
  if (localized) {
    localized->map_id = *drive_.map_id;
    localized->odom_id = drive_.odom_id;
    drive_.last_done_ns = scan.stamp_ns;
    scans_.publish(std::move(*localized), waiting.published_ns);
    context_.note_since_scan("scan_to_pose", waiting.published_ns);
    use_early_answers(scan);
  } else {
    scans_.answer_again(scan.scanner.scanner_id, scan.stamp_ns);
  }
  publish_finished_submaps();
}

void LocalizationService::publish_finished_submaps() {
  while (auto submap = localizer_.take_finished_submap()) {
    submap->map_id = *drive_.map_id;
    submaps_.publish(*submap);
  }
}

app::CommandResult LocalizationService::finish_submap() {
  localizer_.finish();
  publish_finished_submaps();
  return {app::CommandOutcome::kDone,
          std::to_string(localizer_.counters().map.submaps) + " submaps"};
}

}  // namespace slammot::localization
