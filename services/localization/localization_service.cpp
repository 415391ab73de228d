#include "services/localization/localization_service.hpp"

#include <algorithm>

#include <spdlog/spdlog.h>

#include "common/wire/scan_labels.hpp"
#include "common/wire/segmented_scan.hpp"
#include "common/wire/sensor.hpp"
#include "common/wire/text.hpp"
#include "common/wire/tracked_objects.hpp"
#include "services/localization/localization_fields.hpp"
#include "services/localization/saved_session.hpp"

namespace slammot::localization {
namespace {

using namespace std::chrono_literals;

/// How many turns of the loop, of at least this length, a scan waits for odometry of its time. Not a time: where the machine
/// is slow, odometry that is there is read before a scan gives it up.
constexpr auto kTurn = 10ms;
constexpr int kOdometryPatience = 5;
/// The first one waits longer: the bus finds the odometry's writer when it does, and after a crash nothing else bridges the gap.
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
constexpr std::size_t kRecentOdometry = 64;

/// Unlike that of any map before, unless the clock was set back to the very nanosecond.
flow::MapId new_map_id() { return {static_cast<std::uint64_t>(std::chrono::system_clock::now().time_since_epoch().count())}; }

std::filesystem::path checkpoint_path(const app::ServiceOptions& options) {
  return options.state_dir / ("localization-" + options.vehicle_id + "-" + options.instance + ".checkpoint");
}

}  // namespace

std::vector<config::BoundStage> LocalizationService::stages(Settings& settings) {
  return {config::bind_stage("localization", localization_fields(), settings.config)};
}

LocalizationService::LocalizationService(app::ServiceContext& context, const Settings& settings)
    : context_(context),
      config_(settings.config),
      localizer_(settings.config),
      checkpoint_(checkpoint_path(context.options())),
      localized_scans_(context.write(dds::topics::kLocalizedScan)),
      tiles_(context.write(dds::topics::kSubmapTile)) {
  using app::Input;
  // In this order also when several wait: what is known about earlier scans goes into the map before the next is matched.
  context.read(dds::topics::kGraphCorrection, Input::kOccasional, [this](const auto& sample) { take(sample); });
  context.read(dds::topics::kSegmentedScan, Input::kSteady, [this](const auto& sample) { take(sample); });
  context.read(dds::topics::kTrackedObjects, Input::kSteady, [this](const auto& sample) { take(sample); });
  context.read(dds::topics::kScanLabels, Input::kSteady, [this](const auto& sample) { take(sample); });
  context.read(dds::topics::kOdometry, Input::kSteady, [this](const auto& sample) { take(sample); });
  context.read(dds::topics::kLaserScan, Input::kSteady, [this](const auto& sample) { take(sample); });
  context.every(kTurn, [this] {
    for (WaitingScan& waiting : waiting_) ++waiting.turns;
    localize_waiting();
  });
  context.before_report([this] { context_.status().set_counters(named(localizer_.counters())); });
  context.on_command("finish_submap", [this](std::string_view) { return finish_submap(); });
}

template <typename Value>
bool LocalizationService::is_good(const wire::Decoded<Value>& decoded, std::string_view topic) {
  if (!decoded) context_.warn("faulty_" + std::string(topic), "dropped a " + std::string(topic) + ": " + std::string(decoded.fault()));
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
  if (!added.fault.empty()) context_.warn("faulty_graph_correction", "dropped a graph correction: " + std::string(added.fault));
  if (!added.correction) return;
  if (!map_id_) early_corrections_[added.correction->map_id] = std::move(*added.correction);
  else if (added.correction->map_id == *map_id_) localizer_.correct(*added.correction);
}

bool LocalizationService::awaits_odometry(const WaitingScan& waiting) const {
  return !localizer_.has_odometry_for(waiting.scan.stamp_ns) && waited_in_vain_ < kVainWaits &&
         waiting.turns <= (map_id_ ? kOdometryPatience : kFirstOdometryPatience);
}

/// Labels come by a way of their own, and so do the objects that tracking publishes before them.
bool LocalizationService::is_tracking_awaited() const { return localizer_.awaits_labels() || newest_objects_ns_ < newest_labels_ns_; }

/// What tracking says about a scan is better known before the next is matched. It is given a few turns, and nothing where
/// scans queue up or it has been late.
bool LocalizationService::awaits_tracking(const WaitingScan& waiting) const {
  return is_tracking_awaited() && waiting_.size() == 1 && waiting.turns < kTrackingPatience && waited_for_tracking_in_vain_ < kVainWaits;
}

void LocalizationService::localize_waiting() {
  while (!waiting_.empty() && !awaits_odometry(waiting_.front()) && !awaits_tracking(waiting_.front())) {
    const WaitingScan waiting = std::move(waiting_.front());
    waiting_.pop_front();
    if (!localizer_.has_odometry_for(waiting.scan.stamp_ns)) ++waited_in_vain_;
    if (is_tracking_awaited()) ++waited_for_tracking_in_vain_;
    if (is_of_this_drive(waiting)) localize(waiting.scan);
  }
}

/// Begins a new map where a new drive begins.
bool LocalizationService::is_of_this_drive(const WaitingScan& waiting) {
  if (!map_id_ && come_back(waiting)) return true;
  const DriveWatch::Scan scan = drives_.judge(waiting.scan.scanner.scanner_id, waiting.drive_id);
  if (scan == DriveWatch::Scan::kOfEarlierDrive) {
    context_.warn("scans_of_earlier_drives", "dropped a scan of an earlier drive");
    return false;
  }
  if (!map_id_ || scan == DriveWatch::Scan::kOfNewDrive) begin_map();
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
    last_done_ns_ = scan.stamp_ns;
    localized_scans_.write(scan_encoder_.encode(context_.vehicle_id(), *localized));
    last_published_[scanner_id] = std::move(*localized);
  } else if (const auto last = last_published_.find(scanner_id); last != last_published_.end()) {
    // The sender has no answer to a scan that is done, or begins its drive again: the newest one tells both how far it is.
    localized_scans_.write(scan_encoder_.encode(context_.vehicle_id(), last->second));
  }
  publish_finished_submaps();
}

void LocalizationService::tell_whereabouts(bool was_lost, std::uint64_t astray_before) {
  if (localizer_.counters().astray > astray_before) {
    spdlog::warn("did not find itself: submap {} is tied to nothing until loop closing finds its place", localizer_.local_map().submap_id().value);
  } else if (localizer_.is_lost() && !was_lost) {
    spdlog::warn("lost: scans do not fit the map where the vehicle should be; looks for it in the local map");
  } else if (was_lost && !localizer_.is_lost()) {
    spdlog::info("found itself again in the local map");
  }
  if (localizer_.is_lost()) context_.status().set_trouble("lost", "looks for itself in the local map");
  else context_.status().clear_trouble("lost");
}

/// From the checkpoint, if it is of this scan's drive.
bool LocalizationService::come_back(const WaitingScan& first) {
  const auto saved = checkpoint_.read();
  if (!saved) return false;
  const auto session = session_of(saved->bytes);
  if (!session) {
    spdlog::warn("begins a new map: the checkpoint is of another version");
    return false;
  }
  const auto drive = session->drive_by_scanner.find(first.scan.scanner.scanner_id);
  if (drive == session->drive_by_scanner.end() || drive->second != first.drive_id) {
    spdlog::info("begins a new map: the checkpoint is of another drive");
    return false;
  }
  if (!localizer_.restore(session->localizer)) {
    spdlog::warn("begins a new map: the checkpoint is of another version or configuration");
    return false;
  }
  map_id_ = session->map_id;
  drives_.take_up(session->drive_by_scanner);
  for (const flow::LocalizedScan& answer : session->last_answers) last_published_[answer.scanner_id] = answer;
  if (const auto correction = early_corrections_.find(*map_id_); correction != early_corrections_.end()) localizer_.correct(correction->second);
  ++context_.status().counter("restored_checkpoints");
  spdlog::info("goes on from a checkpoint {:.1f} s before this scan", static_cast<double>(first.scan.stamp_ns - saved->stamp_ns) * 1e-9);
  return true;
}

void LocalizationService::begin_map() {
  withdraw_submaps();
  localizer_ = Localizer(config_);
  add_odometry_of_new_drive();
  last_published_.clear();
  last_done_ns_.reset();
  saved_ns_.reset();
  map_id_ = new_map_id();
  ++context_.status().counter("maps");
  spdlog::info("begins map {}", map_id_->value);
}

/// It came before the first scan: what came since stamps last went back.
void LocalizationService::add_odometry_of_new_drive() {
  const auto goes_back = [](const sensing::Odometry& after, const sensing::Odometry& before) { return after.stamp_ns < before.stamp_ns; };
  const auto earliest = std::adjacent_find(recent_odometry_.rbegin(), recent_odometry_.rend(), goes_back);
  const auto first = earliest == recent_odometry_.rend() ? recent_odometry_.begin() : std::prev(earliest.base());
  std::for_each(first, recent_odometry_.end(), [this](const sensing::Odometry& odometry) { localizer_.add_odometry(odometry); });
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
  SavedSession session{*map_id_, drives_.drives(), {}, localizer_.checkpoint()};
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
    std::uint32_t& tiles = published_tiles_[submap->submap_id] = 0;
    submap_encoder_.encode(context_.vehicle_id(), *submap, [&](const slammot_SubmapTile& tile) {
      int attempts = 0;
      while (tiles_.write(tile) == dds::WriteResult::kTimedOut && ++attempts < kTileAttempts) {
      }
      if (attempts == kTileAttempts) context_.warn("lost_tiles", "a reader is slow: a submap tile was not sent");
      ++tiles;
    });
    ++context_.status().counter("published_submaps");
  }
}

app::CommandResult LocalizationService::finish_submap() {
  localizer_.finish();
  publish_finished_submaps();
  return {app::CommandOutcome::kDone, std::to_string(localizer_.counters().submaps) + " submaps"};
}

}  // namespace slammot::localization
