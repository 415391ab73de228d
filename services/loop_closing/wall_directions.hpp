#pragma once

#include <array>
#include <cstddef>
#include <span>

#include "common/flow/submap.hpp"

namespace slammot::loop_closing {

/// Angle histogram of wall normals, without their sign: two scans of one place have equal
/// histograms up to a shift by the heading between them (Weiss, Wetzler and von Puttkamer, IROS
/// 1994).
class WallDirections {
 public:
  explicit WallDirections(std::span<const flow::Surfel> surfels);

  /// True if at least 40 % of the surfels have a normal.
  bool has_walls() const { return has_walls_; }

  /// Correlation with the histogram of another place turned by `by_rad`, normalized to [0, 1].
  double correlation(const WallDirections& turned, double by_rad) const;

 private:
  static constexpr std::size_t kBins = 90;  // 2 degrees each
  std::array<double, kBins> shares_{};      // smoothed, norm 1
  bool has_walls_ = false;
};

/// Headings of `target_from_source` at which the walls of both may coincide.
class PlausibleHeadings {
 public:
  PlausibleHeadings(const WallDirections& target, const WallDirections& source);

  /// True for all headings if one of the places has few walls, or walls in all directions.
  bool contains(double heading_rad) const;

 private:
  WallDirections target_;
  WallDirections source_;
  double least_correlation_ = 0.0;
};

}  // namespace slammot::loop_closing
