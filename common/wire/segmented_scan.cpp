#include "common/wire/segmented_scan.hpp"

#include <algorithm>
#include <stdexcept>

#include "common/wire/labels.hpp"
#include "common/wire/parts.hpp"
#include "common/wire/scan_header.hpp"
#include "common/wire/sensor.hpp"
#include "common/wire/text.hpp"

namespace slammot::wire {
namespace {

static_assert(static_cast<int>(flow::PointLabel::kNoEcho) == slammot_POINT_LABEL_NO_ECHO);
static_assert(static_cast<int>(flow::PointLabel::kStationary) == slammot_POINT_LABEL_STATIONARY);
static_assert(static_cast<int>(flow::PointLabel::kMoving) == slammot_POINT_LABEL_MOVING);
static_assert(static_cast<int>(flow::PointLabel::kUnknown) == slammot_POINT_LABEL_UNKNOWN);

slammot_Segment encode_segment(const flow::Segment& segment) {
  slammot_Segment sample{};
  sample.segment_id = segment.segment_id;
  sample.label = encode(segment.label);
  sample.beam_count = static_cast<std::uint16_t>(segment.beams.size());
  sample.centroid_in_odom_m = encode(segment.centroid_in_odom_m);
  encode_matrix<2>(segment.centroid_covariance_m2, sample.centroid_covariance_m2);
  sample.box_centre_in_odom_m = encode(segment.box_centre_in_odom_m);
  sample.box_heading_rad = segment.box_heading_rad;
  sample.box_length_m = segment.box_length_m;
  sample.box_width_m = segment.box_width_m;
  sample.moving_share = segment.moving_share;
  sample.occluded_at_start = segment.occluded_at_start;
  sample.occluded_at_end = segment.occluded_at_end;
  return sample;
}

flow::Segment decode_segment(const slammot_Segment& sample, std::span<const std::uint16_t> beams) {
  return {.segment_id = sample.segment_id,
          .label = decode(sample.label),
          .beams = {beams.begin(), beams.end()},
          .centroid_in_odom_m = decode(sample.centroid_in_odom_m),
          .centroid_covariance_m2 = decode_matrix<2>(sample.centroid_covariance_m2),
          .box_centre_in_odom_m = decode(sample.box_centre_in_odom_m),
          .box_heading_rad = sample.box_heading_rad,
          .box_length_m = sample.box_length_m,
          .box_width_m = sample.box_width_m,
          .moving_share = sample.moving_share,
          .occluded_at_start = sample.occluded_at_start,
          .occluded_at_end = sample.occluded_at_end};
}

/// The segments that travel, in their order: all, or the kMostSegments largest.
std::vector<const flow::Segment*> segments_that_travel(const std::vector<flow::Segment>& segments) {
  std::vector<const flow::Segment*> chosen;
  chosen.reserve(segments.size());
  for (const flow::Segment& segment : segments) chosen.push_back(&segment);
  if (chosen.size() <= kMostSegments) return chosen;
  std::stable_sort(chosen.begin(), chosen.end(),
                   [](const flow::Segment* a, const flow::Segment* b) {
                     return a->beams.size() > b->beams.size();
                   });
  chosen.resize(kMostSegments);
  std::sort(chosen.begin(), chosen.end());
  return chosen;
}

std::string_view fault_of(const slammot_Segment& segment) {
  if (!is_enumerator(segment.label, slammot_POINT_LABEL_UNKNOWN))
    return "a segment's label is unknown";
  if (!is_sound(segment.centroid_in_odom_m)) return "a centroid is not finite";
  if (!is_covariance<2>(segment.centroid_covariance_m2))
    return "a centroid's covariance is unsound";
  if (!is_sound(segment.box_centre_in_odom_m) || !is_sound(segment.box_heading_rad))
    return "a box is not finite";
  if (!is_amount(segment.box_length_m) || !is_amount(segment.box_width_m))
    return "a box has no sound size";
  if (!is_probability(segment.moving_share)) return "moving_share is not within 0 and 1";
  return "";
}

std::string_view fault_of_segments(const slammot_SegmentedScan& sample) {
  std::size_t beams_of_segments = 0;
  for (const slammot_Segment& segment : elements(sample.segments)) {
    if (const std::string_view fault = fault_of(segment); !fault.empty()) return fault;
    beams_of_segments += segment.beam_count;
  }
  const auto beams = elements(sample.segment_beams);
  if (beams_of_segments != beams.size())
    return "segment_beams does not have what the segments count";
  const auto is_of_scan = [&](std::uint16_t beam) { return beam < sample.ranges_m._length; };
  if (!std::all_of(beams.begin(), beams.end(), is_of_scan))
    return "a segment has a beam that the scan does not have";
  return "";
}

std::string_view fault_of(const slammot_SegmentedScan& sample) {
  if (const std::string_view fault = fault_of_scan_header(sample); !fault.empty()) return fault;
  const std::uint32_t beams = sample.ranges_m._length;
  if (sample.points_in_base._length != beams || sample.labels._length != beams) {
    return "points, ranges and labels are not equally many";
  }
  for (const slammot_Point2f& point : elements(sample.points_in_base)) {
    if (!is_sound(point)) return "an end point is not finite";
  }
  for (const float range_m : elements(sample.ranges_m)) {
    if (!is_amount(range_m)) return "a range is negative or not finite";
  }
  if (!are_labels(elements(sample.labels))) return "a label is unknown";
  return fault_of_segments(sample);
}

}  // namespace

slammot_PointLabel encode(flow::PointLabel label) { return static_cast<slammot_PointLabel>(label); }
flow::PointLabel decode(slammot_PointLabel label) { return static_cast<flow::PointLabel>(label); }

bool are_labels(std::span<const slammot_PointLabel> labels) {
  return std::all_of(labels.begin(), labels.end(), [](const slammot_PointLabel& label) {
    return is_enumerator(label, slammot_POINT_LABEL_UNKNOWN);
  });
}

void encode_labels(const std::vector<flow::PointLabel>& from, std::vector<slammot_PointLabel>& to) {
  to.clear();
  for (const flow::PointLabel label : from) to.push_back(encode(label));
}

std::vector<flow::PointLabel> decode_labels(std::span<const slammot_PointLabel> labels) {
  std::vector<flow::PointLabel> decoded;
  decoded.reserve(labels.size());
  for (const slammot_PointLabel label : labels) decoded.push_back(decode(label));
  return decoded;
}

void SegmentedScanEncoder::encode_segments(const std::vector<flow::Segment>& segments) {
  segments_.clear();
  segment_beams_.clear();
  for (const flow::Segment* segment : segments_that_travel(segments)) {
    segments_.push_back(encode_segment(*segment));
    segment_beams_.insert(segment_beams_.end(), segment->beams.begin(), segment->beams.end());
  }
  if (segment_beams_.size() > kMostBeams)
    throw std::length_error("segments have more beams than fit on the bus");
}

const slammot_SegmentedScan& SegmentedScanEncoder::encode(std::string_view vehicle_id,
                                                          const flow::SegmentedScan& scan,
                                                          std::int64_t scan_published_ns) {
  if (scan.range_m.size() > kMostBeams)
    throw std::length_error("a segmented scan has more beams than fit on the bus");
  points_in_base_.clear();
  for (const Eigen::Vector2f& point : scan.points_in_base_m)
    points_in_base_.push_back(wire::encode(point));
  ranges_m_ = scan.range_m;
  encode_labels(scan.labels, labels_);
  encode_segments(scan.segments);
  encode_scan_header(vehicle_id, scan, sample_);
  sample_.scan_published_ns = scan_published_ns;
  show(sample_.points_in_base, points_in_base_);
  show(sample_.ranges_m, ranges_m_);
  show(sample_.labels, labels_);
  show(sample_.segments, segments_);
  show(sample_.segment_beams, segment_beams_);
  return sample_;
}

Decoded<flow::SegmentedScan> decode(const slammot_SegmentedScan& sample) {
  if (const std::string_view fault = fault_of(sample); !fault.empty()) return Fault{fault};
  const auto ranges_m = elements(sample.ranges_m);
  auto scan = decode_scan_header<flow::SegmentedScan>(sample);
  scan.range_m.assign(ranges_m.begin(), ranges_m.end());
  scan.labels = decode_labels(elements(sample.labels));
  scan.points_in_base_m.reserve(ranges_m.size());
  for (const slammot_Point2f& point : elements(sample.points_in_base))
    scan.points_in_base_m.push_back(decode(point));
  auto beams = elements(sample.segment_beams);
  scan.segments.reserve(sample.segments._length);
  for (const slammot_Segment& segment : elements(sample.segments)) {
    scan.segments.push_back(decode_segment(segment, beams.first(segment.beam_count)));
    beams = beams.subspan(segment.beam_count);
  }
  return scan;
}

}  // namespace slammot::wire
