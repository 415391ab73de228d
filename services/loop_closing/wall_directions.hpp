#pragma once

#include <array>
#include <cstddef>
#include <span>

#include "common/flow/submap.hpp"

namespace slammot::loop_closing {

/// Histogram of the directions of walls: places that are the same have the same, turned by the
/// heading between them (Weiss, Wetzler, von Puttkamer, IROS 1994: angle histograms). Normals count
/// without their sign.
class WallDirections {
 public:
  explicit WallDirections(std::span<const flow::Surfel> surfels);

  /// Whether most of the surfels have a direction.
  bool has_walls() const { return has_walls_; }

  /// Correlation with another place that is turned by this angle, in [0, 1] of the product of the
  /// norms.
  double correlation(const WallDirections& turned, double by_rad) const;

 private:
  static constexpr std::size_t kBins = 90;  // of two degrees
  std::array<double, kBins> shares_{};      // smoothed; norm 1
  bool has_walls_ = false;
};

/// Headings target_from_source by which the walls of both may lie on each other.
class PlausibleHeadings {
 public:
  PlausibleHeadings(const WallDirections& target, const WallDirections& source);

  /// True for all where one of them has few walls, or walls in all directions.
  bool contains(double heading_rad) const;

 private:
  WallDirections target_;
  WallDirections source_;
  double least_correlation_ = 0.0;
};

}  // namespace slammot::loop_closing
