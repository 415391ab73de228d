#include "examples/greedy_tracker/greedy_tracker_service.hpp"

#include "common/wire/segmented_scan.hpp"
#include "examples/greedy_tracker/greedy_tracker_fields.hpp"

namespace slammot::greedy_tracker {

std::vector<config::BoundStage> GreedyTrackerService::stages(Settings& settings) {
  return {config::bind_stage("tracking", greedy_tracker_fields(), settings.config)};
}

GreedyTrackerService::GreedyTrackerService(app::ServiceContext& context, const Settings& settings)
    : context_(context),
      config_(settings.config),
      tracker_(settings.config),
      objects_(context.write(dds::topics::kTrackedObjects)),
      labels_(context.write(dds::topics::kScanLabels)) {
  context.read(dds::topics::kSegmentedScan, app::Input::kSteady,
               [this](const auto& sample) { take(sample); });
  context.before_report([this] { context_.status().set_counters(tracker_.named_counters()); });
}

void GreedyTrackerService::take(const slammot_SegmentedScan& sample) {
  const auto scan = wire::decode(sample);
  if (!scan)
    return context_.warn("faulty_segmented_scan",
                         "dropped a segmented scan: " + std::string(scan.fault()));
  begin_drive_of(*scan);
  const auto last = last_results_.find(scan->scanner_id);
  // A scan that was sent again: repeats the lost answer.
  if (last != last_results_.end() && scan->stamp_ns <= last->second.labels.stamp_ns)
    return publish(last->second, sample.scan_published_ns);
  const app::Stopwatch stopwatch(context_.status().latency("track"));
  publish(last_results_[scan->scanner_id] = tracker_.step(*scan), sample.scan_published_ns);
  context_.note_since_scan("scan_to_tracks", sample.scan_published_ns);
}

/// Discards the tracks of another map or another frame odom.
void GreedyTrackerService::begin_drive_of(const flow::SegmentedScan& scan) {
  const std::pair drive{scan.map_id, scan.odom_id};
  if (drive_ == drive) return;
  drive_ = drive;
  tracker_ = GreedyTracker(config_);
  last_results_.clear();
}

/// Publishes objects before labels: the labels trigger the next scan, for which localization needs
/// the objects.
void GreedyTrackerService::publish(const stages::TrackingResult& result,
                                   std::int64_t scan_published_ns) {
  objects_.write(objects_encoder_.encode(context_.vehicle_id(), result.objects, scan_published_ns));
  labels_.write(labels_encoder_.encode(context_.vehicle_id(), result.labels, scan_published_ns));
}

}  // namespace slammot::greedy_tracker
