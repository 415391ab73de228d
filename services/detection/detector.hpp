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

namespace slammot::detection {

struct DetectionConfig {
  sensing::SegmentationConfig segmentation;
  double longest_mover_m = 16.0;        ///< What is longer does not move as one thing.
  double range_noise_m = 0.03;          ///< One sigma at the scanner.
};

/// Neighbouring echoes of one label, as indices into the beams of what is cut.
struct Run {
  std::size_t first = 0;
  std::size_t count = 0;
  bool is_moving = false;
};

/// Cuts scans into segments and tells which of them contradict the map, and so move.
/// Consistency-based and MO-map-based detection of Wang 2004, Section 6.2. Every other echo is in exactly one segment.
/// Echoes from the ground (Section 6.6) are labelled kNoEcho and in no segment, because they tell of nothing that stands or moves.
/// Keeps nothing from scan to scan but memory: given back what it made of the last one, it allocates nothing in the long run.
class Detector {
 public:
  /// With help (null: none), which must outlive this, the results are the same.
  explicit Detector(const DetectionConfig& config, work::SideWork* help = nullptr) : config_(config), help_(help) {}

  /// done_with: a scan that nobody needs any more; its memory is used again, nothing else of it.
  flow::SegmentedScan detect(const flow::LocalizedScan& scan, flow::SegmentedScan done_with = {});

 private:
  void leave_out_ground(flow::SegmentedScan& scan);
  void cut(const flow::LocalizedScan& localized, flow::SegmentedScan& scan);
  void finish_segments(const flow::LocalizedScan& localized, flow::SegmentedScan& scan);

  static constexpr std::size_t kRanges = 4;  ///< In which segments are finished: they are of very different sizes.
  DetectionConfig config_;
  work::SideWork* help_;
  memory::Spares<flow::Segment> spare_segments_;
  /// Of the scan at hand; kept to reuse the memory.
  BeamDirections directions_;
  std::vector<char> is_ground_;
  std::vector<float> range_without_ground_m_;
  std::vector<sensing::BeamSpan> spans_;
  std::vector<std::uint16_t> beams_;
  std::vector<Run> runs_;
  std::array<std::vector<geometry::Vector2>, kRanges> points_in_odom_m_;
};

/// The same of a single scan.
flow::SegmentedScan detect(const flow::LocalizedScan& scan, const DetectionConfig& config);

}  // namespace slammot::detection
