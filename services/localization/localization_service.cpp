#include "services/localization/localization_service.hpp"

#include <spdlog/spdlog.h>

#include "common/wire/scan_labels.hpp"
#include "common/wire/segmented_scan.hpp"
#include "common/wire/sensor.hpp"
#include "common/wire/text.hpp"
#include "common/wire/tracked_objects.hpp"
#include "services/localization/localization_fields.hpp"

namespace slammot::localization {
namespace {

using namespace std::chrono_literals;

/// How long a scan waits for odometry of its time, and how many do so in vain before none is expected any more.
constexpr auto kOdometryPatience = 50ms;
constexpr int kVainWaits = 3;
/// A checkpoint is made when the last one is this old, by the data's clock.
constexpr std::int64_t kCheckpointPeriodNs = 1'000'000'000;
/// A checkpoint that is older than this, by the data's clock, is from another drive.
constexpr std::int64_t kLongestAbsenceNs = 60'000'000'000;
/// A tile that a slow reader holds up is tried again so often.
constexpr int kTileAttempts = 20;

std::filesystem::path checkpoint_path(const app::ServiceOptions& options) {
  return options.state_dir / ("localization-" + options.vehicle_id + "-" + options.instance + ".checkpoint");
}

}  // namespace

std::vector<config::BoundStage> LocalizationService::stages(Settings& settings) {
  return {config::bind_stage("localization", localization_fields(), settings.config)};
}

LocalizationService::LocalizationService(app::ServiceContext& context, const Settings& settings)
    : context_(context),
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
  context.every(10ms, [this] { localize_waiting(); });
  context.every(1s, [this] { context_.status().set_counters(named(localizer_.counters())); });
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
  waiting_.push_back({std::move(*scan), std::chrono::steady_clock::now()});
  localize_waiting();
}

void LocalizationService::take(const slammot_Odometry& sample) {
  const auto odometry = wire::decode(sample);
  if (!is_good(odometry, "odometry")) return;
  waited_in_vain_ = 0;
  localizer_.add_odometry(*odometry);
  localize_waiting();
}

void LocalizationService::take(const slammot_SegmentedScan& sample) {
  const auto segmented = wire::decode(sample);
  if (is_good(segmented, "segmented_scan")) localizer_.note(*segmented);
}

void LocalizationService::take(const slammot_TrackedObjects& sample) {
  const auto objects = wire::decode(sample);
  if (is_good(objects, "tracked_objects")) localizer_.expect(*objects);
}

void LocalizationService::take(const slammot_ScanLabels& sample) {
  const auto labels = wire::decode(sample);
  if (!is_good(labels, "scan_labels")) return;
  const app::Stopwatch stopwatch(context_.status().latency("integrate"));
  localizer_.integrate(*labels);
  publish_finished_submaps();
}

void LocalizationService::take(const slammot_GraphCorrection& sample) {
  auto added = corrections_.add(sample);
  if (!added.fault.empty()) context_.warn("faulty_graph_correction", "dropped a graph correction: " + std::string(added.fault));
  if (!added.correction) return;
  newest_correction_ = std::move(added.correction);
  correct_if_driven_so_far();
}

/// A correction kept from another drive speaks of submaps that this one has not come to.
void LocalizationService::correct_if_driven_so_far() {
  if (!newest_correction_ || !has_begun_) return;
  const auto& submaps = newest_correction_->submaps;
  if (!submaps.empty() && submaps.back().submap_id > submap_in_use_) return;
  localizer_.correct(*newest_correction_);
  newest_correction_.reset();
}

bool LocalizationService::may_localize(const WaitingScan& waiting) const {
  return localizer_.has_odometry_for(waiting.scan.stamp_ns) || waited_in_vain_ >= kVainWaits ||
         std::chrono::steady_clock::now() - waiting.since > kOdometryPatience;
}

void LocalizationService::localize_waiting() {
  while (!waiting_.empty() && may_localize(waiting_.front())) {
    const sensing::LaserScan scan = std::move(waiting_.front().scan);
    waiting_.pop_front();
    if (!localizer_.has_odometry_for(scan.stamp_ns)) ++waited_in_vain_;
    localize(scan);
  }
}

void LocalizationService::localize(const sensing::LaserScan& scan) {
  if (!has_begun_) come_back(scan.stamp_ns);
  if (last_done_ns_) save_checkpoint(*last_done_ns_);
  correct_if_driven_so_far();
  const std::string& scanner_id = scan.scanner.scanner_id;
  const app::Stopwatch stopwatch(context_.status().latency("localize"));
  if (auto localized = localizer_.localize(scan)) {
    submap_in_use_ = localized->submap_id;
    last_done_ns_ = scan.stamp_ns;
    localized_scans_.write(scan_encoder_.encode(context_.vehicle_id(), *localized));
    last_published_[scanner_id] = std::move(*localized);
  } else if (const auto last = last_published_.find(scanner_id); last != last_published_.end()) {
    // The sender has no answer to a scan that is done, or begins its drive again: the newest one tells both how far it is.
    localized_scans_.write(scan_encoder_.encode(context_.vehicle_id(), last->second));
  }
  publish_finished_submaps();
}

/// From the checkpoint, if it is of this drive: the first scan tells.
void LocalizationService::come_back(std::int64_t stamp_ns) {
  has_begun_ = true;
  const auto saved = checkpoint_.read();
  if (!saved) return;
  const std::int64_t absence_ns = stamp_ns - saved->stamp_ns;
  if (absence_ns < 0 || absence_ns > kLongestAbsenceNs) {
    spdlog::info("begins a new map: the checkpoint is of another drive");
  } else if (!localizer_.restore(saved->bytes)) {
    spdlog::warn("begins a new map: the checkpoint is of another version or configuration");
  } else {
    ++context_.status().counter("restored_checkpoints");
    submap_in_use_ = localizer_.local_map().submap_id();
    spdlog::info("goes on from a checkpoint {:.1f} s before this scan", static_cast<double>(absence_ns) * 1e-9);
  }
}

void LocalizationService::save_checkpoint(std::int64_t stamp_ns) {
  if (saved_ns_ && stamp_ns - *saved_ns_ < kCheckpointPeriodNs) return;
  if (checkpoint_.is_busy()) return;
  const app::Stopwatch stopwatch(context_.status().latency("checkpoint"));
  const std::string fault = checkpoint_.fault();
  if (!fault.empty()) context_.warn("failed_checkpoints", fault);
  checkpoint_.save({stamp_ns, localizer_.checkpoint()});
  saved_ns_ = stamp_ns;
}

void LocalizationService::publish_finished_submaps() {
  while (const auto submap = localizer_.take_finished_submap()) {
    submap_encoder_.encode(context_.vehicle_id(), *submap, [this](const slammot_SubmapTile& tile) {
      int attempts = 0;
      while (tiles_.write(tile) == dds::WriteResult::kTimedOut && ++attempts < kTileAttempts) {
      }
      if (attempts == kTileAttempts) context_.warn("lost_tiles", "a reader is slow: a submap tile was not sent");
    });
    ++context_.status().counter("published_submaps");
  }
}

app::CommandResult LocalizationService::finish_submap() {
  localizer_.finish();
  publish_finished_submaps();
  context_.status().set_counters(named(localizer_.counters()));
  return {app::CommandOutcome::kDone, std::to_string(localizer_.counters().submaps) + " submaps"};
}

}  // namespace slammot::localization
