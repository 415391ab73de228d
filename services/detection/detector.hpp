#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "common/flow/localized_scan.hpp"
#include "common/flow/segmented_scan.hpp"
#include "common/memory/spares.hpp"
#include "common/sensing/segmentation.hpp"
#include "common/work/side_work.hpp"
#include "services/detection/beam_directions.hpp"
#include "services/detection/clutter.hpp"
#include "services/detection/detection_config.hpp"
#include "services/detection/label_runs.hpp"

namespace slammot::detection {

/// Segments scans and labels the segments that contradict the map as moving: consistency-based and
/// MO-map-based detection of Wang 2004, section 6.2. Every echo is in exactly one segment, except
/// echoes from the ground (section 6.6) and false ones, which are labelled kNoEcho. Keeps the
/// echoes of the last scan of each scanner, and memory: with the previous result as `recycled` it
/// does not allocate in the long run.
class Detector {
 public:
  /// Runs in parallel on `help` (null: none), which must outlive the detector. Results do not
  /// depend on it.
  explicit Detector(const DetectionConfig& config, work::SideWork* help = nullptr)
      : config_(config), help_(help) {}

  /// `recycled`: a result no longer needed, whose memory is reused.
  flow::SegmentedScan detect(const flow::LocalizedScan& scan, flow::SegmentedScan recycled = {});

 private:
  void remove_ground(flow::SegmentedScan& scan);
  void remove_clutter(flow::SegmentedScan& scan);
  void create_segments(const flow::LocalizedScan& localized, flow::SegmentedScan& scan);
  void describe_segments(const flow::LocalizedScan& localized, flow::SegmentedScan& scan);

  static constexpr std::size_t kRanges = 4;  ///< Ranges of segments that are processed in parallel.
  DetectionConfig config_;
  work::SideWork* help_;
  memory::Spares<flow::Segment> spare_segments_;
  Clutter clutter_;
  /// Buffers of the present scan.
  BeamDirections directions_;
  std::vector<char> is_ground_;
  std::vector<char> is_clutter_;
  std::vector<float> range_without_ground_m_;
  std::vector<sensing::BeamSpan> spans_;
  std::vector<std::uint16_t> beams_;
  std::vector<Run> runs_;
  std::array<std::vector<geometry::Vector2>, kRanges> points_in_odom_m_;
};

/// Segments and labels a single scan.
flow::SegmentedScan detect(const flow::LocalizedScan& scan, const DetectionConfig& config);

}  // namespace slammot::detection
