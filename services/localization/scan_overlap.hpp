#pragma once

#include "common/grids/surfel_map.hpp"
#include "common/matching/point_to_line.hpp"
#include "services/localization/localizer_config.hpp"
#include "services/localization/scan_points.hpp"

namespace slammot::localization {

/// How much of what the scan before has seen a scan sees again. Keeps its memory.
class ScanOverlap {
 public:
  explicit ScanOverlap(const LocalizerConfig& config);

  /// The points of the scan at hand: the scan before is registered to them.
  void map_points(const ScanPoints& points);
  const grids::SurfelMap& surfels() const { return surfels_; }

  /// Share of the scan before, in [0, 1], that lies on this one, starting from that pose.
  double before_on_scan(const ScanPoints& points, const geometry::Pose2& now_from_before);

 private:
  double robust_scale_m_;
  matching::PointToLineConfig match_;
  grids::SurfelMap surfels_;  ///< Of the scan, in its base.
  matching::PointToLineMatcher matcher_;
};

}  // namespace slammot::localization
