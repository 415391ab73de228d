#include "services/localization/localization_service_scans.hpp"

#include <utility>

namespace slammot::localization {

ScanPublisher::ScanPublisher(app::ServiceContext& context)
    : context_(context), scans_(context.write(dds::topics::kLocalizedScan)) {
  context.after(app::RepeatWatch::kBegins, [this] {
    for (const std::string& scanner_id : repeats_.take_owed()) publish_newest(scanner_id);
  });
}

void ScanPublisher::publish(flow::LocalizedScan scan, std::int64_t scan_published_ns) {
  scans_.write(encoder_.encode(context_.vehicle_id(), scan, scan_published_ns));
  const std::string scanner_id = scan.scanner_id;
  newest_[scanner_id] = std::move(scan);
}

void ScanPublisher::answer_again(const std::string& scanner_id, std::int64_t stamp_ns) {
  const auto newest = newest_.find(scanner_id);
  if (newest != newest_.end() &&
      repeats_.asks_for_answer(scanner_id, stamp_ns, newest->second.stamp_ns))
    publish_newest(scanner_id);
}

void ScanPublisher::publish_newest(const std::string& scanner_id) {
  const auto newest = newest_.find(scanner_id);
  if (newest != newest_.end()) scans_.write(encoder_.encode(context_.vehicle_id(), newest->second));
}

void ScanPublisher::take_up(const std::vector<flow::LocalizedScan>& newest) {
  for (const flow::LocalizedScan& scan : newest) newest_[scan.scanner_id] = scan;
}

std::vector<flow::LocalizedScan> ScanPublisher::newest() const {
  std::vector<flow::LocalizedScan> scans;
  for (const auto& [scanner_id, scan] : newest_) {
    scans.push_back(scan);
    scans.back().beams.clear();
  }
  return scans;
}

}  // namespace slammot::localization
