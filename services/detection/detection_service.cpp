#include "services/detection/detection_service.hpp"

#include <string>
#include <utility>

#include "common/wire/localized_scan.hpp"
#include "services/detection/detection_fields.hpp"

namespace slammot::detection {

std::vector<config::BoundStage> DetectionService::stages(Settings& settings) {
  return {config::bind_stage("detection", detection_fields(), settings.config)};
}

DetectionService::DetectionService(app::ServiceContext& context, const Settings& settings)
    : context_(context),
      detector_(settings.config),
      segmented_scans_(context.write(dds::topics::kSegmentedScan)) {
  context.read(
      dds::topics::kLocalizedScan, app::Input::kSteady,
      [this](const auto& sample) { take(sample); }, dds::History::kRestart);
}

void DetectionService::take(const slammot_LocalizedScan& sample) {
  const auto scan = wire::decode(sample);
  if (!scan)
    return context_.warn("faulty_localized_scan",
                         "dropped a localized scan: " + std::string(scan.fault()));
  const app::Stopwatch stopwatch(context_.status().latency("detect"));
  segmented_scan_ = detector_.detect(*scan, std::move(segmented_scan_));
  segmented_scans_.write(
      encoder_.encode(context_.vehicle_id(), segmented_scan_, sample.scan_published_ns));
  context_.note_since_scan("scan_to_segments", sample.scan_published_ns);
  ++context_.status().counter("scans");
}

}  // namespace slammot::detection
