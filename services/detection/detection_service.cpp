#include "services/detection/detection_service.hpp"

#include <string>
#include <utility>

#include "common/wire/localized_scan.hpp"
#include "services/detection/detection_fields.hpp"

namespace slammot::detection {

std::vector<config::BoundStage> DetectionService::stages(Settings& settings) {
  return {config::bind_stage("detection", detection_fields(), settings.config)};
}

void DetectionService::prepare(app::ServiceContext& context) {
  context.prepare(dds::topics::kLocalizedScan, dds::History::kRestart);
  context.prepare(dds::topics::kSegmentedScan, dds::History::kProfile);
  context.prepare_to_write(dds::topics::kSegmentedScan);
}

DetectionService::DetectionService(app::ServiceContext& context, const Settings& settings)
    : context_(context),
      detector_(settings.config),
      segmented_scans_(context.write(dds::topics::kSegmentedScan)) {
  context.take_up(dds::topics::kSegmentedScan, [this](const slammot_SegmentedScan& sample) {
    if (const auto done = wire::decode(sample))
      done_before_[done->scanner_id] = {done->odom_id, done->stamp_ns};
  });
  context.read(
      dds::topics::kLocalizedScan, app::Input::kSteady,
      [this](const auto& sample) { take(sample); }, dds::History::kRestart);
}

void DetectionService::take(const slammot_LocalizedScan& sample) {
  const auto scan = wire::decode(sample);
  if (!scan)
    return context_.warn("faulty_localized_scan",
                         "dropped a localized scan: " + std::string(scan.fault()));
  if (was_done_before(*scan)) return;
  const app::Stopwatch stopwatch(context_.status().latency("detect"));
  segmented_scan_ = detector_.detect(*scan, std::move(segmented_scan_));
  segmented_scans_.write(
      encoder_.encode(context_.vehicle_id(), segmented_scan_, sample.scan_published_ns));
  context_.note_since_scan("scan_to_segments", sample.scan_published_ns);
  ++context_.status().counter("scans");
}

/// The bus gives scans of the last seconds, of which the leader before has left a few.
bool DetectionService::was_done_before(const flow::LocalizedScan& scan) {
  const auto done = done_before_.find(scan.scanner_id);
  if (done == done_before_.end()) return false;
  if (done->second.odom_id == scan.odom_id && scan.stamp_ns < done->second.stamp_ns) return true;
  done_before_.erase(done);
  return false;
}

}  // namespace slammot::detection
