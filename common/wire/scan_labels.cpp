#include "common/wire/scan_labels.hpp"

#include <stdexcept>

#include "common/wire/labels.hpp"
#include "common/wire/parts.hpp"
#include "common/wire/sensor.hpp"
#include "common/wire/text.hpp"

namespace slammot::wire {
namespace {

std::string_view fault_of(const slammot_ScanLabels& sample) {
  if (!are_labels(elements(sample.labels))) return "a label is unknown";
  std::size_t points = 0;
  for (const slammot_RestoredPoints& scan : elements(sample.restored_scans))
    points += scan.beam_count;
  if (points != sample.restored_beams._length)
    return "restored_beams does not have what the restored scans count";
  for (const std::uint16_t beam : elements(sample.restored_beams)) {
    if (beam >= kMostBeams) return "a restored beam is one that no scan has";
  }
  return "";
}

}  // namespace

void ScanLabelsEncoder::encode_restored(const std::vector<flow::RestoredPoints>& restored) {
  restored_scans_.clear();
  restored_beams_.clear();
  for (const flow::RestoredPoints& scan : restored) {
    if (restored_scans_.size() == kMostRestoredScans) return;
    if (restored_beams_.size() + scan.beams.size() > kMostRestoredPoints) return;
    restored_scans_.push_back({scan.sequence, static_cast<std::uint16_t>(scan.beams.size())});
    restored_beams_.insert(restored_beams_.end(), scan.beams.begin(), scan.beams.end());
  }
}

const slammot_ScanLabels& ScanLabelsEncoder::encode(std::string_view vehicle_id,
                                                    const flow::ScanLabels& labels,
                                                    std::int64_t scan_published_ns) {
  if (labels.labels.size() > kMostBeams) throw std::length_error("more labels than fit on the bus");
  encode_labels(labels.labels, labels_);
  encode_restored(labels.restored);
  set_text(sample_.vehicle_id, vehicle_id);
  set_text(sample_.scanner_id, labels.scanner_id);
  sample_.scan_published_ns = scan_published_ns;
  sample_.stamp_ns = labels.stamp_ns;
  sample_.sequence_number = labels.sequence;
  show(sample_.labels, labels_);
  show(sample_.restored_scans, restored_scans_);
  show(sample_.restored_beams, restored_beams_);
  return sample_;
}

Decoded<flow::ScanLabels> decode(const slammot_ScanLabels& sample) {
  if (const std::string_view fault = fault_of(sample); !fault.empty()) return Fault{fault};
  flow::ScanLabels labels{.stamp_ns = sample.stamp_ns,
                          .sequence = sample.sequence_number,
                          .scanner_id = std::string(text(sample.scanner_id)),
                          .labels = decode_labels(elements(sample.labels)),
                          .restored = {}};
  auto beams = elements(sample.restored_beams);
  for (const slammot_RestoredPoints& scan : elements(sample.restored_scans)) {
    const auto of_scan = beams.first(scan.beam_count);
    labels.restored.push_back({scan.sequence_number, {of_scan.begin(), of_scan.end()}});
    beams = beams.subspan(scan.beam_count);
  }
  return labels;
}

}  // namespace slammot::wire
