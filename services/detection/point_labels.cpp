#include "services/detection/point_labels.hpp"

#include <algorithm>

namespace slammot::detection {
namespace {

using flow::EndCell;
using flow::LocalizedBeam;
using flow::LocalizedScan;
using flow::PointLabel;
using flow::SegmentedScan;
using geometry::Vector2;

constexpr double kLeastFreeLogOdds = 0.8;        ///< Least log-odds of free space that make an echo
                                                 ///< there moving.
constexpr double kOutlineTolerancePerM = 0.006;  ///< Increase of kOutlineToleranceM per metre of
                                                 ///< range.

PointLabel label_of(const LocalizedBeam& beam) {
  switch (beam.end_cell) {
    case EndCell::kNoEcho: return PointLabel::kNoEcho;
    case EndCell::kOccupied: return PointLabel::kStationary;
    case EndCell::kFree:
      return beam.free_evidence >= kLeastFreeLogOdds ? PointLabel::kMoving : PointLabel::kUnknown;
    case EndCell::kUnseen: break;
  }
  return PointLabel::kUnknown;
}

/// End points that the map predicts for the beams, in base. Beams for which it predicts none have
/// no end point.
class ExpectedOutline {
 public:
  ExpectedOutline(const LocalizedScan& scan, const BeamDirections& directions)
      : scan_(scan), directions_(directions) {}

  /// True if the echo lies near the polyline through the end points of neighbouring beams. At
  /// grazing incidence an echo of a wall is far from its own beam's end point but near the wall's
  /// line.
  bool contains(std::size_t beam) const {
    const LocalizedBeam& echo = scan_.beams[beam];
    const double within_m =
        kOutlineToleranceM + kOutlineTolerancePerM * static_cast<double>(echo.range_m);
    const Vector2 point = echo.point_in_base_m.cast<double>();
    const std::size_t first = beam < flow::kExpectedAside ? 0 : beam - flow::kExpectedAside;
    const std::size_t last = std::min(beam + flow::kExpectedAside + 1, scan_.beams.size());
    for (std::size_t i = first; i < last; ++i) {
      if (!has_end(i)) continue;
      const Vector2 end = end_of(i);
      if ((point - end).squaredNorm() < within_m * within_m) return true;
      if (i + 1 == last || !has_end(i + 1)) continue;
      const Vector2 way = end_of(i + 1) - end;
      const double length2 = way.squaredNorm();
      if (length2 > kMaxFaceM * kMaxFaceM) continue;
      const double share = std::clamp(way.dot(point - end) / std::max(length2, 1e-9), 0.0, 1.0);
      if ((point - end - share * way).squaredNorm() < within_m * within_m) return true;
    }
    return false;
  }

 private:
  static constexpr double kMaxFaceM = 6.0;  ///< Longest face between end points of neighbouring
                                            ///< beams; a greater distance is a gap between objects.
  bool has_end(std::size_t beam) const {
    return static_cast<double>(scan_.beams[beam].expected_range_m) < scan_.max_range_m - 0.5;
  }
  Vector2 end_of(std::size_t beam) const {
    return scan_.base_from_laser.translation_m() +
           static_cast<double>(scan_.beams[beam].expected_range_m) * directions_[beam];
  }
  const LocalizedScan& scan_;
  const BeamDirections& directions_;
};

}  // namespace

void label_points(const LocalizedScan& scan, const BeamDirections& directions,
                  SegmentedScan& segmented) {
  segmented.points_in_base_m.resize(scan.beams.size());
  segmented.range_m.resize(scan.beams.size());
  segmented.labels.resize(scan.beams.size());
  const ExpectedOutline outline(scan, directions);
  for (std::size_t i = 0; i < scan.beams.size(); ++i) {
    segmented.points_in_base_m[i] = scan.beams[i].point_in_base_m;
    segmented.range_m[i] = scan.beams[i].range_m;
    segmented.labels[i] = label_of(scan.beams[i]);
    if (segmented.labels[i] == PointLabel::kMoving && outline.contains(i))
      segmented.labels[i] = PointLabel::kStationary;
  }
}

}  // namespace slammot::detection
