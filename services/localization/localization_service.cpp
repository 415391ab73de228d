#include "services/localization/localization_service.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <spdlog/spdlog.h>
#include <CLI/CLI.hpp>

#include "common/wire/scan_labels.hpp"
#include "common/wire/segmented_scan.hpp"
#include "common/wire/sensor.hpp"
#include "common/wire/text.hpp"
#include "common/wire/tracked_objects.hpp"
#include "services/localization/localization_fields.hpp"

namespace slammot::localization {
namespace {

using namespace std::chrono_literals;

/// How many turns of the loop, of at least this length, a scan waits for odometry of its time. Not
/// a time: where the machine is slow, odometry that is there is read before a scan gives it up.
constexpr auto kTurn = 10ms;
constexpr int kOdometryPatience = 5;
/// The first one waits longer: the bus finds the odometry's writer when it does, and after a crash
/// nothing else bridges the gap.
constexpr int kFirstOdometryPatience = 50;
/// How many turns it waits for what tracking says about the scan before it.
constexpr int kTrackingPatience = 3;
/// How many wait in vain before none is expected any more.
constexpr int kVainWaits = 3;
/// A checkpoint is made when the last one is this old, by the data's clock.
constexpr std::int64_t kCheckpointPeriodNs = 1'000'000'000;
/// A tile that a slow reader holds up is tried again so often.
constexpr int kTileAttempts = 20;
/// Of what came before the first scan of a drive, no more than this is of use.
constexpr std::size_t kRecentOdometry = 300;
/// A live sensor's scans do not pile up until the stored map is known: a vehicle wants to know
/// where it is now.
constexpr std::size_t kScansBeforeMap = 100;

/// Unlike any before, unless the clock was set back to the very nanosecond.
std::uint64_t new_id() {
  return static_cast<std::uint64_t>(std::chrono::system_clock::now().time_since_epoch().count());
}

std::int64_t monotonic_ns() {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(
             std::chrono::steady_clock::now().time_since_epoch())
      .count();
}

std::filesystem::path checkpoint_path(const app::ServiceOptions& options) {
  return options.state_dir /
         ("localization-" + options.vehicle_id + "-" + options.instance + ".checkpoint");
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
      ->check(CLI::Range(0.1, 3600.0));
}

LocalizationService::LocalizationService(app::ServiceContext& context, const Settings& settings)
    : context_(context),
      config_(settings.config),
      localizer_(settings.config),
      checkpoint_(checkpoint_path(context.options())),
      localized_scans_(context.write(dds::topics::kLocalizedScan)),
      tiles_(context.write(dds::topics::kSubmapTile)) {
  using app::Input;
  if (settings.continues_map) {
    stored_map_.emplace(std::llround(settings.map_patience_s * 1e9), config_.map.cell_size_m,
                        monotonic_ns());
    context.read(dds::topics::kStoredMap, Input::kOccasional,
                 [this](const auto& sample) { take(sample); });
    is_stored_map_known();  // so that nobody takes it for ready before the first turn
  }
  // In this order also when several wait: what is known about earlier scans goes into the map
  // before the next is matched.
  context.read(dds::topics::kGraphCorrection, Input::kOccasional,
               [this](const auto& sample) { take(sample); });
  context.read(dds::topics::kSegmentedScan, Input::kSteady,
               [this](const auto& sample) { take(sample); });
  context.read(dds::topics::kTrackedObjects, Input::kSteady,
               [this](const auto& sample) { take(sample); });
  context.read(dds::topics::kScanLabels, Input::kSteady,
               [this](const auto& sample) { take(sample); });
  context.read(dds::topics::kOdometry, Input::kSteady,
               [this](const auto& sample) { take(sample); });
  context.read(dds::topics::kLaserScan, Input::kSteady,
               [this](const auto& sample) { take(sample); });
  context.every(kTurn, [this] {
    for (WaitingScan& waiting : waiting_) ++waiting.turns;
    if (stored_map_ && !map_id_) is_stored_map_known();
    localize_waiting();
  });
  context.before_report([this] { context_.status().set_counters(named(localizer_.counters())); });
  context.on_command("finish_submap", [this](std::string_view) { return finish_submap(); });
}

template <typename Value>
bool LocalizationService::is_good(const wire::Decoded<Value>& decoded, std::string_view topic) {
  if (!decoded)
    context_.warn("faulty_" + std::string(topic),
                  "dropped a " + std::string(topic) + ": " + std::string(decoded.fault()));
  return static_cast<bool>(decoded);
}

void LocalizationService::take(const slammot_LaserScan& sample) {
  auto scan = wire::decode(sample);
  if (!is_good(scan, "laser_scan")) return;
  waiting_.push_back({std::move(*scan), sample.drive_id});
  localize_waiting();
}

void LocalizationService::take(const slammot_Odometry& sample) {
  if (!config_.use_odometry) return;  // nor is it waited for
  const auto odometry = wire::decode(sample);
  if (!is_good(odometry, "odometry")) return;
  waited_in_vain_ = 0;
  localizer_.add_odometry(*odometry);
  recent_odometry_.push_back(*odometry);
  if (recent_odometry_.size() > kRecentOdometry) recent_odometry_.pop_front();
  localize_waiting();
}

void LocalizationService::take(const slammot_SegmentedScan& sample) {
  const auto segmented = wire::decode(sample);
  if (is_good(segmented, "segmented_scan")) localizer_.note(*segmented);
}

void LocalizationService::take(const slammot_TrackedObjects& sample) {
  const auto objects = wire::decode(sample);
  if (!is_good(objects, "tracked_objects")) return;
  localizer_.expect(*objects);
  newest_objects_ns_ = objects->stamp_ns;
  if (!is_tracking_awaited()) waited_for_tracking_in_vain_ = 0;
  localize_waiting();
}

void LocalizationService::take(const slammot_ScanLabels& sample) {
  const auto labels = wire::decode(sample);
  if (!is_good(labels, "scan_labels")) return;
  const app::Stopwatch stopwatch(context_.status().latency("integrate"));
  localizer_.integrate(*labels);
  newest_labels_ns_ = labels->stamp_ns;
  if (!is_tracking_awaited()) waited_for_tracking_in_vain_ = 0;
  publish_finished_submaps();
  localize_waiting();
}

void LocalizationService::take(const slammot_GraphCorrection& sample) {
  auto added = corrections_.add(sample);
  if (!added.fault.empty())
    context_.warn("faulty_graph_correction",
                  "dropped a graph correction: " + std::string(added.fault));
  if (!added.correction) return;
  if (stored_map_) stored_map_->is_placed(*added.correction, monotonic_ns());
  if (!map_id_) early_corrections_[added.correction->map_id] = std::move(*added.correction);
  else if (added.correction->map_id == *map_id_) correct(*added.correction);
}

/// One that tells of none of this drive's submaps is about the frame odom of a drive before.
void LocalizationService::correct(const flow::GraphCorrection& correction) {
  if (correction.submaps.empty() || correction.submaps.back().submap_id < first_submap_) return;
  localizer_.correct(correction);
  tell_whether_it_is_tied(!correction.is_untied);
}

void LocalizationService::tell_whether_it_is_tied(bool is_tied) {
  if (is_tied) context_.status().clear_trouble("place");
  else
    context_.status().set_trouble("place", "not found in the map yet: poses in map mean nothing");
}

void LocalizationService::take(const slammot_StoredMap& sample) {
  const auto stored = wire::decode(sample);
  if (!is_good(stored, "stored_map")) return;
  stored_map_->is_stored(*stored, monotonic_ns());
  localize_waiting();
}

bool LocalizationService::awaits_odometry(const WaitingScan& waiting) const {
  return !localizer_.has_odometry_for(waiting.scan.stamp_ns) && waited_in_vain_ < kVainWaits &&
         waiting.turns <= (map_id_ ? kOdometryPatience : kFirstOdometryPatience);
}

/// Labels come by a way of their own, and so do the objects that tracking publishes before them.
bool LocalizationService::is_tracking_awaited() const {
  return localizer_.awaits_labels() || newest_objects_ns_ < newest_labels_ns_;
}

/// What tracking says about a scan is better known before the next is matched. It is given a few
/// turns, and nothing where scans queue up or it has been late.
bool LocalizationService::awaits_tracking(const WaitingScan& waiting) const {
  return is_tracking_awaited() && waiting_.size() == 1 && waiting.turns < kTrackingPatience &&
         waited_for_tracking_in_vain_ < kVainWaits;
}

void LocalizationService::localize_waiting() {
  while (!waiting_.empty() && !awaits_odometry(waiting_.front()) &&
         !awaits_tracking(waiting_.front()) && knows_map_of(waiting_.front())) {
    const WaitingScan waiting = std::move(waiting_.front());
    waiting_.pop_front();
    if (!localizer_.has_odometry_for(waiting.scan.stamp_ns)) ++waited_in_vain_;
    if (is_tracking_awaited()) ++waited_for_tracking_in_vain_;
    if (is_of_this_drive(waiting)) localize(waiting.scan);
  }
}

/// Where drives go on in the stored map, the first scan of one waits until that is known.
bool LocalizationService::knows_map_of(const WaitingScan& waiting) {
  if (!map_id_ && come_back(waiting)) return true;
  const bool is_new =
      !map_id_ || drives_.look_at(waiting.scan.scanner.scanner_id, waiting.drive_id) ==
                      DriveWatch::Scan::kOfNewDrive;
  if (!stored_map_ || !is_new) return true;
  if (map_id_) end_drive();
  else hand_over_earlier_drive();
  if (is_stored_map_known()) return true;
  while (waiting_.size() > kScansBeforeMap) {
    waiting_.pop_front();
    ++context_.status().counter("scans_before_map");
  }
  return false;
}

/// Says in the status what is waited for, or what is wrong with it.
bool LocalizationService::is_stored_map_known() {
  const StoredMapWatch::Answer answer = stored_map_->answer(monotonic_ns());
  const bool waits = answer.verdict == StoredMapWatch::Verdict::kWait;
  context_.status().set_starting(waits);
  if (waits)
    context_.status().set_trouble("stored_map", "waits for the stored map: " + answer.reason);
  else if (answer.verdict == StoredMapWatch::Verdict::kCannot)
    context_.status().set_trouble("stored_map", "cannot go on in the stored map: " + answer.reason);
  else context_.status().clear_trouble("stored_map");
  return !waits;
}

/// Begins a map where a new drive begins, or goes on in the stored one.
bool LocalizationService::is_of_this_drive(const WaitingScan& waiting) {
  const DriveWatch::Scan scan = drives_.judge(waiting.scan.scanner.scanner_id, waiting.drive_id);
  if (scan == DriveWatch::Scan::kOfEarlierDrive) {
    context_.warn("scans_of_earlier_drives", "dropped a scan of an earlier drive");
    return false;
  }
  if (!map_id_ || scan == DriveWatch::Scan::kOfNewDrive) begin_drive();
  return true;
}

void LocalizationService::localize(const sensing::LaserScan& scan) {
  if (last_done_ns_) save_checkpoint(*last_done_ns_);
  const std::string& scanner_id = scan.scanner.scanner_id;
  const app::Stopwatch stopwatch(context_.status().latency("localize"));
  const bool was_lost = localizer_.is_lost();
  const std::uint64_t astray_before = localizer_.counters().astray;
  auto localized = localizer_.localize(scan);
  tell_whereabouts(was_lost, astray_before);
  if (localized) {
    localized->map_id = *map_id_;
    localized->odom_id = odom_id_;
    last_done_ns_ = scan.stamp_ns;
    localized_scans_.write(scan_encoder_.encode(context_.vehicle_id(), *localized));
    last_published_[scanner_id] = std::move(*localized);
  } else if (const auto last = last_published_.find(scanner_id); last != last_published_.end()) {
    // The sender has no answer to a scan that is done, or begins its drive again: the newest one
    // tells both how far it is.
    localized_scans_.write(scan_encoder_.encode(context_.vehicle_id(), last->second));
  }
  publish_finished_submaps();
}

void LocalizationService::tell_whereabouts(bool was_lost, std::uint64_t astray_before) {
  if (localizer_.counters().astray > astray_before) {
    spdlog::warn(
        "did not find itself: submap {} is tied to nothing until loop closing finds its place",
        localizer_.local_map().submap_id().value);
  } else if (localizer_.is_lost() && !was_lost) {
    spdlog::warn(
        "lost: scans do not fit the map where the vehicle should be; looks for it in the local "
        "map");
  } else if (was_lost && !localizer_.is_lost()) {
    spdlog::info("found itself again in the local map");
  }
  if (localizer_.is_lost())
    context_.status().set_trouble("lost", "looks for itself in the local map");
  else context_.status().clear_trouble("lost");
}

/// From the checkpoint, if it is of this scan's drive.
bool LocalizationService::come_back(const WaitingScan& first) {
  if (std::exchange(has_looked_back_, true)) return false;
  const auto saved = checkpoint_.read();
  if (!saved) return false;
  auto session = session_of(saved->bytes);
  if (!session) {
    spdlog::warn("begins a new map: the checkpoint is of another version");
    return false;
  }
  const auto drive = session->drive_by_scanner.find(first.scan.scanner.scanner_id);
  if (drive == session->drive_by_scanner.end() || drive->second != first.drive_id) {
    spdlog::info("the checkpoint is of another drive");
    earlier_drive_ = std::move(*session);
    return false;
  }
  if (!localizer_.restore(session->localizer)) {
    spdlog::warn("begins a new map: the checkpoint is of another version or configuration");
    return false;
  }
  map_id_ = session->map_id;
  odom_id_ = session->odom_id;
  first_submap_ = session->first_submap_id;
  drives_.take_up(session->drive_by_scanner);
  for (const flow::LocalizedScan& answer : session->last_answers)
    last_published_[answer.scanner_id] = answer;
  tell_whether_it_is_tied(first_submap_.value == 0);
  if (const auto correction = early_corrections_.find(*map_id_);
      correction != early_corrections_.end())
    correct(correction->second);
  context_.status().set_starting(false);
  context_.status().clear_trouble("stored_map");
  ++context_.status().counter("restored_checkpoints");
  spdlog::info("goes on from a checkpoint {:.1f} s before this scan",
               static_cast<double>(first.scan.stamp_ns - saved->stamp_ns) * 1e-9);
  return true;
}

/// The vehicle was switched off in the middle of a submap of the stored map: what the checkpoint
/// has of it is its next one.
void LocalizationService::hand_over_earlier_drive() {
  if (!earlier_drive_ || !stored_map_->map()) return;
  const SavedSession session = *std::exchange(earlier_drive_, std::nullopt);
  Localizer localizer(config_);
  if (session.map_id != stored_map_->map()->map_id || !localizer.restore(session.localizer)) return;
  localizer.finish();
  auto submap = localizer.take_finished_submap();
  if (!submap || submap->submap_id.value != stored_map_->map()->last_submap_id.value + 1) return;
  submap->map_id = session.map_id;
  publish(*submap);
  stored_map_->is_on_its_way(session.map_id, submap->submap_id, monotonic_ns());
  spdlog::info("hands over submap {}, with which the drive before ended", submap->submap_id.value);
}

/// Its last submap is on its way into the map in which the next drive goes on.
void LocalizationService::end_drive() {
  localizer_.finish();
  publish_finished_submaps();
  if (!published_tiles_.empty())
    stored_map_->is_on_its_way(*map_id_, published_tiles_.rbegin()->first, monotonic_ns());
}

void LocalizationService::begin_drive() {
  localizer_ = Localizer(config_);
  add_odometry_of_new_drive();
  last_published_.clear();
  last_done_ns_.reset();
  saved_ns_.reset();
  odom_id_ = {new_id()};
  const auto verdict = stored_map_ ? stored_map_->answer(monotonic_ns()).verdict
                                   : StoredMapWatch::Verdict::kNothingStored;
  if (verdict == StoredMapWatch::Verdict::kGoOn) return go_on_in_stored_map();
  if (verdict == StoredMapWatch::Verdict::kCannot)
    ++context_.status().counter("begun_without_stored_map");
  begin_map();
}

void LocalizationService::begin_map() {
  withdraw_submaps();
  map_id_ = {odom_id_.value};
  first_submap_ = {};
  tell_whether_it_is_tied(true);
  ++context_.status().counter("maps");
  spdlog::info("begins map {}", map_id_->value);
}

/// The graph is corrected as for the drive before, so that only what comes later is news.
void LocalizationService::go_on_in_stored_map() {
  const flow::StoredMap& stored = *stored_map_->map();
  if (map_id_ != stored.map_id) withdraw_submaps();
  map_id_ = stored.map_id;
  first_submap_ = {stored.last_submap_id.value + 1};
  localizer_.correct(stored_map_->graph());
  localizer_.go_on_after(stored_map_->graph().submaps.back());
  tell_whether_it_is_tied(false);
  ++context_.status().counter("continued_maps");
  spdlog::info("goes on in map {} after its {} submaps", map_id_->value, stored.submaps);
}

/// It came before the first scan: what came since stamps last went back.
void LocalizationService::add_odometry_of_new_drive() {
  const auto goes_back = [](const sensing::Odometry& after, const sensing::Odometry& before) {
    return after.stamp_ns < before.stamp_ns;
  };
  const auto earliest =
      std::adjacent_find(recent_odometry_.rbegin(), recent_odometry_.rend(), goes_back);
  const auto first =
      earliest == recent_odometry_.rend() ? recent_odometry_.begin() : std::prev(earliest.base());
  std::for_each(first, recent_odometry_.end(),
                [this](const sensing::Odometry& odometry) { localizer_.add_odometry(odometry); });
}

/// A map_store that starts later must not take them for the new map's.
void LocalizationService::withdraw_submaps() {
  slammot_SubmapTile key{};
  wire::set_text(key.vehicle_id, context_.vehicle_id());
  for (const auto& [submap_id, tiles] : published_tiles_) {
    key.submap_id = submap_id.value;
    for (key.tile_index = 0; key.tile_index < tiles; ++key.tile_index) tiles_.end(key);
  }
  published_tiles_.clear();
}

void LocalizationService::save_checkpoint(std::int64_t stamp_ns) {
  if (saved_ns_ && stamp_ns - *saved_ns_ < kCheckpointPeriodNs) return;
  if (checkpoint_.is_busy()) return;
  const app::Stopwatch stopwatch(context_.status().latency("checkpoint"));
  const std::string fault = checkpoint_.fault();
  if (!fault.empty()) context_.warn("failed_checkpoints", fault);
  SavedSession session{*map_id_,         odom_id_, first_submap_,
                       drives_.drives(), {},       localizer_.checkpoint()};
  for (const auto& [scanner_id, answer] : last_published_) {
    session.last_answers.push_back(answer);
    session.last_answers.back().beams.clear();
  }
  checkpoint_.save({stamp_ns, to_bytes(session)});
  saved_ns_ = stamp_ns;
}

void LocalizationService::publish_finished_submaps() {
  while (auto submap = localizer_.take_finished_submap()) {
    submap->map_id = *map_id_;
    publish(*submap);
  }
}

void LocalizationService::publish(const flow::Submap& submap) {
  std::uint32_t& tiles = published_tiles_[submap.submap_id] = 0;
  submap_encoder_.encode(context_.vehicle_id(), submap, [&](const slammot_SubmapTile& tile) {
    int attempts = 0;
    while (tiles_.write(tile) == dds::WriteResult::kTimedOut && ++attempts < kTileAttempts) {}
    if (attempts == kTileAttempts)
      context_.warn("lost_tiles", "a reader is slow: a submap tile was not sent");
    ++tiles;
  });
  ++context_.status().counter("published_submaps");
}

app::CommandResult LocalizationService::finish_submap() {
  localizer_.finish();
  publish_finished_submaps();
  return {app::CommandOutcome::kDone, std::to_string(localizer_.counters().submaps) + " submaps"};
}

}  // namespace slammot::localization
