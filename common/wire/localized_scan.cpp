#include "common/wire/localized_scan.hpp"

#include <stdexcept>

#include "common/wire/parts.hpp"
#include "common/wire/scan_header.hpp"
#include "common/wire/sensor.hpp"
#include "common/wire/text.hpp"

namespace slammot::wire {
namespace {

static_assert(static_cast<int>(flow::EndCell::kNoEcho) == slammot_END_CELL_NO_ECHO);
static_assert(static_cast<int>(flow::EndCell::kUnseen) == slammot_END_CELL_UNSEEN);
static_assert(static_cast<int>(flow::EndCell::kFree) == slammot_END_CELL_FREE);
static_assert(static_cast<int>(flow::EndCell::kOccupied) == slammot_END_CELL_OCCUPIED);

slammot_LocalizedBeam encode_beam(const flow::LocalizedBeam& beam) {
  return {encode(beam.point_in_base_m), beam.range_m, beam.expected_range_m, beam.free_evidence,
          beam.moving_evidence};
}

flow::LocalizedBeam decode_beam(const slammot_LocalizedBeam& beam, slammot_EndCell end_cell) {
  return {decode(beam.point_in_base), beam.range_m,         beam.expected_range_m,
          beam.free_evidence,         beam.moving_evidence, static_cast<flow::EndCell>(end_cell)};
}

std::string_view fault_of(const slammot_LocalizedBeam& beam) {
  if (!is_sound(beam.point_in_base)) return "an end point is not finite";
  if (!is_amount(beam.range_m) || !is_amount(beam.expected_range_m))
    return "a range is negative or not finite";
  if (!is_sound(beam.free_evidence)) return "free_evidence is not finite";
  if (!is_probability(beam.moving_evidence)) return "moving_evidence is not within 0 and 1";
  return "";
}

std::string_view fault_of(const slammot_LocalizedScan& sample) {
  if (const std::string_view fault = fault_of_scan_header(sample); !fault.empty()) return fault;
  if (!is_sound(sample.speed_mps) || !is_sound(sample.yaw_rate_radps))
    return "the velocity is not finite";
  if (!is_probability(sample.local_variance_share) || sample.local_variance_share == 0.0)
    return "local_variance_share is not within 0 and 1";
  if (!is_sound(sample.submap_from_base)) return "submap_from_base is not finite";
  if (sample.end_cells._length != sample.beams._length)
    return "beams and end_cells are not equally many";
  for (const slammot_EndCell& end_cell : elements(sample.end_cells)) {
    if (!is_enumerator(end_cell, slammot_END_CELL_OCCUPIED)) return "an end cell is unknown";
  }
  for (const slammot_LocalizedBeam& beam : elements(sample.beams)) {
    if (const std::string_view fault = fault_of(beam); !fault.empty()) return fault;
  }
  return "";
}

}  // namespace

const slammot_LocalizedScan& LocalizedScanEncoder::encode(std::string_view vehicle_id,
                                                          const flow::LocalizedScan& scan,
                                                          std::int64_t scan_published_ns) {
  if (scan.beams.size() > kMostBeams)
    throw std::length_error("a localized scan has more beams than fit on the bus");
  beams_.clear();
  end_cells_.clear();
  for (const flow::LocalizedBeam& beam : scan.beams) {
    beams_.push_back(encode_beam(beam));
    end_cells_.push_back(static_cast<slammot_EndCell>(beam.end_cell));
  }
  encode_scan_header(vehicle_id, scan, sample_);
  sample_.scan_published_ns = scan_published_ns;
  sample_.speed_mps = scan.speed_mps;
  sample_.yaw_rate_radps = scan.yaw_rate_radps;
  sample_.submap_id = scan.submap_id.value;
  sample_.submap_from_base = wire::encode(scan.submap_from_base);
  sample_.local_variance_share = scan.local_variance_share;
  show(sample_.beams, beams_);
  show(sample_.end_cells, end_cells_);
  return sample_;
}

Decoded<flow::LocalizedScan> decode(const slammot_LocalizedScan& sample) {
  if (const std::string_view fault = fault_of(sample); !fault.empty()) return Fault{fault};
  auto scan = decode_scan_header<flow::LocalizedScan>(sample);
  scan.speed_mps = sample.speed_mps;
  scan.yaw_rate_radps = sample.yaw_rate_radps;
  scan.submap_id = {sample.submap_id};
  scan.submap_from_base = decode(sample.submap_from_base);
  scan.local_variance_share = sample.local_variance_share;
  const auto beams = elements(sample.beams);
  const auto end_cells = elements(sample.end_cells);
  scan.beams.reserve(beams.size());
  for (std::size_t i = 0; i < beams.size(); ++i)
    scan.beams.push_back(decode_beam(beams[i], end_cells[i]));
  return scan;
}

}  // namespace slammot::wire
