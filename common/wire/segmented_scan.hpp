#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

#include "common/flow/segmented_scan.hpp"
#include "common/wire/decoded.hpp"
#include "idl/detection.h"

namespace slammot::wire {

/// Most segments of a scan that the bus carries.
inline constexpr std::size_t kMostSegments = 448;

/// Puts segmented scans on the wire; keeps its buffers.
class SegmentedScanEncoder {
 public:
  /// scan_published_ns: system clock of the source, 0 where it is unknown. The result is good until
  /// the next call. Of more than kMostSegments the largest travel. Throws std::length_error for
  /// more than kMostBeams, or where segments share beams so often that they do not fit.
  const slammot_SegmentedScan& encode(std::string_view vehicle_id, const flow::SegmentedScan& scan,
                                      std::int64_t scan_published_ns = 0);

 private:
  void encode_segments(const std::vector<flow::Segment>& segments);

  slammot_SegmentedScan sample_{};
  std::vector<slammot_Point2f> points_in_base_;
  std::vector<float> ranges_m_;
  std::vector<slammot_PointLabel> labels_;
  std::vector<slammot_Segment> segments_;
  std::vector<std::uint16_t> segment_beams_;
};

Decoded<flow::SegmentedScan> decode(const slammot_SegmentedScan& sample);

}  // namespace slammot::wire
