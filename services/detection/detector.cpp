#include "services/detection/detector.hpp"

#include <utility>
#include <vector>

#include "services/detection/ground.hpp"
#include "services/detection/point_labels.hpp"
#include "services/detection/segment_description.hpp"

namespace slammot::detection {
namespace {

using flow::LocalizedScan;
using flow::PointLabel;
using flow::SegmentedScan;
using geometry::Matrix2;
using sensing::BeamSpan;

/// Copies the header of the scan; the other fields of `segmented` stay.
SegmentedScan with_header_of(const LocalizedScan& scan, SegmentedScan segmented) {
  segmented.stamp_ns = scan.stamp_ns;
  segmented.sequence = scan.sequence;
  segmented.scanner_id = scan.scanner_id;
  segmented.base_from_laser = scan.base_from_laser;
  segmented.max_range_m = scan.max_range_m;
  segmented.beam_step_rad = scan.beam_step_rad;
  segmented.sweep_s = scan.sweep_s;
  segmented.odom_from_base = scan.odom_from_base;
  // Motion is judged relative to the local map.
  segmented.odom_from_base.covariance *= scan.local_variance_share;
  segmented.map_from_odom = scan.map_from_odom;
  segmented.map_id = scan.map_id;
  segmented.odom_id = scan.odom_id;
  return segmented;
}

void add_echoes(const BeamSpan& span, const std::vector<float>& range_m,
                std::vector<std::uint16_t>& beams) {
  for (std::uint16_t beam = span.first; beam <= span.last; ++beam)
    if (range_m[beam] > 0.0F) beams.push_back(beam);
}

}  // namespace

SegmentedScan Detector::detect(const LocalizedScan& localized, SegmentedScan recycled) {
  SegmentedScan scan = with_header_of(localized, std::move(recycled));
  directions_.compute(localized);
  label_points(localized, directions_, scan);
  remove_ground(scan);
  remove_clutter(scan);
  create_segments(localized, scan);
  describe_segments(localized, scan);
  return scan;
}

void Detector::remove_ground(SegmentedScan& scan) {
  find_ground(scan, directions_, is_ground_);
  range_without_ground_m_ = scan.range_m;
  for (std::size_t i = 0; i < is_ground_.size(); ++i) {
    if (!is_ground_[i]) continue;
    scan.labels[i] = PointLabel::kNoEcho;
    range_without_ground_m_[i] = 0.0F;
  }
}

/// A false echo is the same as none: nothing is known of what lies behind it.
void Detector::remove_clutter(SegmentedScan& scan) {
  clutter_.find(scan, range_without_ground_m_, is_clutter_);
  for (std::size_t i = 0; i < is_clutter_.size(); ++i) {
    if (!is_clutter_[i]) continue;
    scan.labels[i] = PointLabel::kNoEcho;
    scan.range_m[i] = range_without_ground_m_[i] = 0.0F;
  }
}

/// Creates segments and assigns their beams.
void Detector::create_segments(const LocalizedScan& localized, SegmentedScan& scan) {
  sensing::segment_by_distance(scan.points_in_base_m, range_without_ground_m_,
                               localized.beam_step_rad, config_.segmentation, spans_);
  const bool first_span_continues_last =
      sensing::continues_across_seam(scan.points_in_base_m, range_without_ground_m_,
                                     localized.beam_step_rad, config_.segmentation, spans_);
  std::size_t count = 0;
  for (std::size_t i = first_span_continues_last ? 1 : 0; i < spans_.size(); ++i) {
    beams_.clear();
    add_echoes(spans_[i], range_without_ground_m_, beams_);
    if (first_span_continues_last && i + 1 == spans_.size())
      add_echoes(spans_.front(), range_without_ground_m_, beams_);
    split_by_label(beams_, scan, runs_);
    for (const Run& run : runs_) {
      if (count == scan.segments.size()) spare_segments_.resize(scan.segments, count + 1);
      std::vector<std::uint16_t>& beams = scan.segments[count++].beams;
      if (!beams.empty() && beams.capacity() < run.count)
        beams.reserve(scan.range_m.size());  // once for all later scans
      const auto first = beams_.begin() + static_cast<std::ptrdiff_t>(run.first);
      beams.assign(first, first + static_cast<std::ptrdiff_t>(run.count));
    }
  }
  spare_segments_.resize(scan.segments, count);
}

void Detector::describe_segments(const LocalizedScan& localized, SegmentedScan& scan) {
  const Matrix2 odom_from_base_turn = geometry::rotation(localized.odom_from_base.pose.heading_rad);
  const std::size_t count = scan.segments.size();
  work::share(help_, kRanges, [&](std::size_t range) {
    for (std::size_t i = count * range / kRanges; i < count * (range + 1) / kRanges; ++i) {
      scan.segments[i].segment_id = static_cast<std::uint32_t>(i);
      describe_segment(scan.segments[i], localized, config_, scan, odom_from_base_turn,
                       points_in_odom_m_[range]);
    }
  });
}

SegmentedScan detect(const LocalizedScan& scan, const DetectionConfig& config) {
  return Detector(config).detect(scan);
}

}  // namespace slammot::detection
