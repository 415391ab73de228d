#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "services/tracking/scan_context.hpp"

namespace slammot::tracking {

/// Ages of the scans in which faces are looked for [s].
inline constexpr std::array kFaceAgesS{kCompareFastAfterS, 0.4, 0.6, kCompareAfterS,
                                       kCompareSlowAfterS};

/// The earlier scans with which a scan is compared; null where the history is too short.
struct EarlierScans {
  const EarlierScan* usual = nullptr;    ///< kCompareAfterS ago.
  const EarlierScan* recent = nullptr;   ///< kCompareFastAfterS ago; where only people move.
  const EarlierScan* distant = nullptr;  ///< kCompareSlowAfterS ago.
  std::array<const EarlierScan*, kFaceAgesS.size()> for_faces{};  ///< Newest first.
  std::size_t count_for_faces = 0;
};

EarlierScans earlier_scans(const ScanContext& context);

/// What the comparison with earlier scans says of a segment. Counts are of its echoes.
struct SegmentComparison {
  int stood = 0;
  int arrived = 0;
  int receded = 0;
  int came = 0;  ///< Arrived or appeared, since the usual or, where that does not tell, the recent
                 ///< scan.
  int longest_arrival = 0;  ///< Neighbouring echoes that arrived: a moving face, while its flank
                            ///< slides along itself.
  Eigen::Vector2d face_shift_m = Eigen::Vector2d::Zero();  ///< Displacement of its front or rear;
                                                           ///< zero where none is measured.
  bool stood_before = false;                               ///< By the earlier scan.
  bool stands = false;                                     ///< By the earlier scan or the map.
  bool has_come = false;  ///< It is where a vehicle was that has moved there: the same vehicle,
                          ///< standing.
};

/// Comparison of one scan with earlier ones (Wang 2004, Section 6.2, between scans instead of with
/// the map).
class ScanComparison {
 public:
  /// Prepares for this scan. Afterwards compare() must be called once for each segment; calls for
  /// different segments are independent.
  void begin(const ScanContext& context);
  void compare(std::size_t segment, const ScanContext& context);

  std::size_t segment_count() const { return segments_.size(); }
  const SegmentComparison& segment(std::size_t segment) const { return segments_[segment]; }
  Past beam(std::size_t beam) const { return beams_[beam]; }
  /// True if the beam met a face that has moved.
  bool has_shifted(std::size_t beam) const { return has_shifted_[beam] != 0; }

 private:
  void compare_face(std::size_t segment, const ScanContext& context);

  EarlierScans earlier_;
  std::vector<Past> beams_;
  std::vector<SegmentComparison> segments_;
  std::vector<char> has_shifted_;
};

/// The context of a scan after its comparison with earlier ones.
struct ComparedScan : ScanContext {
  const ScanComparison& comparison;
};

/// True if the segment is of a length that may be a vehicle's flank.
bool may_have_flank(const flow::Segment& segment, const TrackingConfig& config);

}  // namespace slammot::tracking
