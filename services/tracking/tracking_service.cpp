#include "services/tracking/tracking_service.hpp"

#include <spdlog/spdlog.h>

#include "common/wire/segmented_scan.hpp"
#include "services/tracking/tracking_fields.hpp"

namespace slammot::tracking {
namespace {

using namespace std::chrono_literals;

/// How long the first scans wait for the tracks of a process before this one.
constexpr auto kStoredTracksPatience = 1s;
constexpr std::size_t kMostEarlyScans = 100;
/// Tracks older than this, by the data's clock, are of objects that are elsewhere by now.
constexpr std::int64_t kLongestAbsenceNs = 5'000'000'000;

/// What the positions of objects are said in.
template <typename Sample>
std::pair<flow::MapId, flow::OdomId> drive_of(const Sample& sample) {
  return {sample.map_id, sample.odom_id};
}

}  // namespace

std::vector<config::BoundStage> TrackingService::stages(Settings& settings) {
  return {config::bind_stage("tracking", tracking_fields(), settings.config)};
}

TrackingService::TrackingService(app::ServiceContext& context, const Settings& settings)
    : context_(context),
      config_(settings.config),
      tracker_(settings.config),
      objects_(context.write(dds::topics::kTrackedObjects)),
      labels_(context.write(dds::topics::kScanLabels)) {
  context.read(dds::topics::kStoredTrackedObjects, app::Input::kOccasional,
               [this](const auto& sample) { take_stored(sample); });
  context.read(dds::topics::kSegmentedScan, app::Input::kSteady,
               [this](const auto& sample) { take(sample); });
  context.after(kStoredTracksPatience, [this] { begin(); });
  context.before_report([this] { context_.status().set_counters(named(tracker_.counters())); });
}

/// Of several that were kept the newest counts; once tracking goes on they are echoes of its own.
void TrackingService::take_stored(const slammot_TrackedObjects& sample) {
  if (!waits_for_stored_tracks_) return;
  auto objects = wire::decode(sample);
  if (!objects)
    return context_.warn("faulty_tracks", "dropped stored tracks: " + std::string(objects.fault()));
  if (!stored_ || objects->stamp_ns > stored_->stamp_ns) stored_ = std::move(*objects);
  context_.after(0s, [this] { begin(); });  // after all that were kept have been taken
}

void TrackingService::take(const slammot_SegmentedScan& sample) {
  auto scan = wire::decode(sample);
  if (!scan)
    return context_.warn("faulty_segmented_scan",
                         "dropped a segmented scan: " + std::string(scan.fault()));
  if (!waits_for_stored_tracks_) return track(*scan);
  early_.push_back(std::move(*scan));
  if (early_.size() > kMostEarlyScans) early_.pop_front();
}

void TrackingService::begin() {
  if (!waits_for_stored_tracks_) return;
  waits_for_stored_tracks_ = false;
  for (const flow::SegmentedScan& scan : early_) track(scan);
  early_.clear();
}

/// Nothing of another drive is known here, if its numbers, its stamps and its map are the same or
/// not.
void TrackingService::begin_drive(const flow::SegmentedScan& first) {
  tracker_ = Tracker(config_);
  last_results_.clear();
  drive_ = drive_of(first);
  if (stored_ && drive_of(*stored_) == drive_) resume(first.stamp_ns);
  stored_.reset();
}

void TrackingService::resume(std::int64_t stamp_ns) {
  const std::int64_t absence_ns = stamp_ns - stored_->stamp_ns;
  if (absence_ns < 0 || absence_ns > kLongestAbsenceNs) return;
  tracker_.resume(*stored_);
  ++context_.status().counter("taken_up");
  spdlog::info("takes up {} tracks", stored_->objects.size());
}

void TrackingService::track(const flow::SegmentedScan& scan) {
  if (drive_ != drive_of(scan)) begin_drive(scan);
  const auto last = last_results_.find(scan.scanner_id);
  if (last != last_results_.end() && scan.stamp_ns <= last->second.labels.stamp_ns) {
    // Sent again because somebody missed the answer.
    ++context_.status().counter("repeated_scans");
    return publish(last->second);
  }
  const app::Stopwatch stopwatch(context_.status().latency("track"));
  TrackingResult& result = last_results_[scan.scanner_id];
  result = tracker_.step(scan);
  publish(result);
}

/// Objects first: localization must know them when the labels let the next scan come.
void TrackingService::publish(const TrackingResult& result) {
  objects_.write(objects_encoder_.encode(context_.vehicle_id(), result.objects));
  labels_.write(labels_encoder_.encode(context_.vehicle_id(), result.labels));
}

}  // namespace slammot::tracking
