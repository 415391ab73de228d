#include "examples/icp_localizer/icp_localizer_service.hpp"

#include <chrono>

#include "common/wire/scan_labels.hpp"
#include "common/wire/sensor.hpp"
#include "examples/icp_localizer/icp_localizer_fields.hpp"

namespace slammot::icp_localizer {
namespace {

using namespace std::chrono_literals;

constexpr auto kCycle = 10ms;
/// Cycles that a scan waits for odometry at its stamp; longer for the first scan, until discovery
/// of the writer.
constexpr int kOdometryWaitCycles = 5;
constexpr int kFirstOdometryPatience = 50;
/// Number of consecutive scans without odometry after which none is expected.
constexpr int kMaxScansWithoutOdometry = 3;
constexpr std::size_t kRecentOdometry = 300;
/// Attempts to write a tile while a reader is slow.
constexpr int kTileAttempts = 20;

std::uint64_t new_id() {
  return static_cast<std::uint64_t>(std::chrono::system_clock::now().time_since_epoch().count());
}

}  // namespace

std::vector<config::BoundStage> IcpLocalizerService::stages(Settings& settings) {
  return {config::bind_stage("localization", icp_localizer_fields(), settings.config)};
}

IcpLocalizerService::IcpLocalizerService(app::ServiceContext& context, const Settings& settings)
    : context_(context),
      config_(settings.config),
      localizer_(settings.config),
      localized_scans_(context.write(dds::topics::kLocalizedScan)),
      tiles_(context.write(dds::topics::kSubmapTile)) {
  using app::Input;
  // In this order: labels and objects of earlier scans are mapped before the next scan is matched.
  context.read(dds::topics::kGraphCorrection, Input::kOccasional,
               [this](const auto& sample) { take(sample); });
  context.read(dds::topics::kScanLabels, Input::kSteady,
               [this](const auto& sample) { take(sample); });
  context.read(dds::topics::kOdometry, Input::kSteady,
               [this](const auto& sample) { take(sample); });
  context.read(
      dds::topics::kLaserScan, Input::kSteady,
      [this](const slammot_LaserScan& sample, const dds::SampleInfo& info) { take(sample, info); });
  context.every(kCycle, [this] {
    for (Waiting& waiting : waiting_) ++waiting.cycles;
    localize_waiting();
  });
  context.before_report([this] { context_.status().set_counters(localizer_.named_counters()); });
  context.on_command("finish_submap", [this](std::string_view) { return finish_submap(); });
}

void IcpLocalizerService::take(const slammot_LaserScan& sample, const dds::SampleInfo& info) {
  auto scan = wire::decode(sample);
  if (!scan)
    return context_.warn("faulty_laser_scan", "dropped a laser scan: " + std::string(scan.fault()));
  waiting_.push_back({std::move(*scan), sample.drive_id, info.source_time_ns});
  localize_waiting();
}

void IcpLocalizerService::take(const slammot_Odometry& sample) {
  const auto odometry = wire::decode(sample);
  if (!odometry)
    return context_.warn("faulty_odometry", "dropped odometry: " + std::string(odometry.fault()));
  localizer_.add_odometry(*odometry);
  recent_odometry_.push_back(*odometry);
  if (recent_odometry_.size() > kRecentOdometry) recent_odometry_.pop_front();
  scans_without_odometry_ = 0;
  localize_waiting();
}

void IcpLocalizerService::take(const slammot_ScanLabels& sample) {
  const auto labels = wire::decode(sample);
  if (!labels)
    return context_.warn("faulty_scan_labels",
                         "dropped scan labels: " + std::string(labels.fault()));
  localizer_.integrate(*labels);
  publish_finished_submaps();
}

void IcpLocalizerService::take(const slammot_GraphCorrection& sample) {
  const auto added = corrections_.add(sample);
  if (!added.fault.empty())
    context_.warn("faulty_graph_correction",
                  "dropped a graph correction: " + std::string(added.fault));
  if (added.correction && added.correction->map_id == map_id_)
    localizer_.correct(*added.correction);
}

bool IcpLocalizerService::awaits_odometry(const Waiting& waiting) const {
  return config_.use_odometry && !localizer_.has_odometry_for(waiting.scan.stamp_ns) &&
         scans_without_odometry_ < kMaxScansWithoutOdometry &&
         waiting.cycles <= (last_published_.empty() ? kFirstOdometryPatience : kOdometryWaitCycles);
}

void IcpLocalizerService::localize_waiting() {
  while (!waiting_.empty() && !awaits_odometry(waiting_.front())) {
    const Waiting waiting = std::move(waiting_.front());
    waiting_.pop_front();
    if (!localizer_.has_odometry_for(waiting.scan.stamp_ns)) ++scans_without_odometry_;
    begin_drive_of(waiting);
    localize(waiting);
  }
}

/// A new drive begins when a known scanner reports another drive id.
void IcpLocalizerService::begin_drive_of(const Waiting& waiting) {
  const std::string& scanner_id = waiting.scan.scanner.scanner_id;
  const auto known = drive_by_scanner_.find(scanner_id);
  const bool is_new = drive_by_scanner_.empty() ||
                      (known != drive_by_scanner_.end() && known->second != waiting.drive_id);
  if (is_new) {
    localizer_ = IcpLocalizer(config_);
    for (const sensing::Odometry& odometry : recent_odometry_) localizer_.add_odometry(odometry);
    drive_by_scanner_.clear();
    last_published_.clear();
    map_id_ = {new_id()};
    ++context_.status().counter("maps");
  }
  drive_by_scanner_[scanner_id] = waiting.drive_id;
}

void IcpLocalizerService::localize(const Waiting& waiting) {
  const app::Stopwatch stopwatch(context_.status().latency("localize"));
  const std::string& scanner_id = waiting.scan.scanner.scanner_id;
  if (auto localized = localizer_.localize(waiting.scan)) {
    localized->map_id = map_id_;
    localized->odom_id = {map_id_.value};
    last_published_[scanner_id] = std::move(*localized);
  }
  // A scan that was sent again: repeats the lost answer.
  if (const auto last = last_published_.find(scanner_id); last != last_published_.end())
    localized_scans_.write(
        scan_encoder_.encode(context_.vehicle_id(), last->second, waiting.published_ns));
  context_.note_since_scan("scan_to_pose", waiting.published_ns);
  publish_finished_submaps();
}

void IcpLocalizerService::publish_finished_submaps() {
  while (auto submap = localizer_.take_finished_submap()) {
    submap->map_id = map_id_;
    submap_encoder_.encode(context_.vehicle_id(), *submap, [this](const slammot_SubmapTile& tile) {
      for (int attempt = 0; attempt < kTileAttempts; ++attempt)
        if (tiles_.write(tile) != dds::WriteResult::kTimedOut) return;
      context_.warn("lost_tiles", "a reader is slow: a submap tile was not sent");
    });
    ++context_.status().counter("published_submaps");
  }
}

app::CommandResult IcpLocalizerService::finish_submap() {
  localizer_.finish();
  publish_finished_submaps();
  return {app::CommandOutcome::kDone, "finished"};
}

}  // namespace slammot::icp_localizer
