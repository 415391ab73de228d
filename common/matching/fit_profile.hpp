#pragma once

#include <span>
#include <vector>

#include "common/grids/surfel_map.hpp"
#include "common/matching/point_to_line.hpp"

namespace slammot::matching {

/// How well points lie on surfels at several positions. Reuses its memory.
class FitProfile {
 public:
  /// At each position with one heading: fit_of() a registration with one fine step from there.
  /// Positions should be sorted along a line: the surfels around a point are looked up once a cell,
  /// and nothing is computed that only a step needs. 18 positions cost a third of the instructions
  /// of 18 registrations. Valid until the next call.
  std::span<const double> fits_at(const std::vector<MatchPoint>& points,
                                  const grids::SurfelMap& surfels, double heading_rad,
                                  std::span<const geometry::Vector2> positions_m,
                                  const PointToLineConfig& config);

 private:
  struct Sums {
    int matched = 0;
    double squared_residuals_m2 = 0.0;
  };

  static void add(const grids::SurfelMap::Surface& surface, const geometry::Vector2& offset_m,
                  Sums& sums);

  std::vector<Sums> sums_;  ///< Of each position.
  std::vector<double> fits_;
};

}  // namespace slammot::matching
