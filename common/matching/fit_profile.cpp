#include "common/matching/fit_profile.hpp"

#include <cmath>

namespace slammot::matching {
namespace {

using geometry::Vector2;

/// The surfels that one point may lie on, looked up anew only where it enters another cell.
class SurfacesAround {
 public:
  SurfacesAround(const grids::SurfelMap& surfels, int radius)
      : surfels_(surfels), radius_(radius) {}

  std::size_t nearest_place(const Vector2& point_m) {
    const grids::Cell cell = surfels_.window().cell_at(point_m.x(), point_m.y());
    if (!has_cell_ || cell != cell_) {
      cell_ = cell;
      has_cell_ = true;
      near_ = surfels_.neighbours_of(cell);
    }
    const std::size_t place = near_.nearest_place(point_m);
    return place == grids::SurfelMap::kNoPlace && radius_ > 1
               ? surfels_.nearest_place(point_m, radius_)
               : place;
  }

 private:
  const grids::SurfelMap& surfels_;
  int radius_;
  bool has_cell_ = false;
  grids::Cell cell_;
  grids::SurfelMap::Neighbours near_;
};

}  // namespace

void FitProfile::add(const grids::SurfelMap::Surface& surface, const Vector2& offset_m,
                     Sums& sums) {
  ++sums.matched;
  if (surface.normal.isZero()) {
    sums.squared_residuals_m2 += 0.5 * offset_m.squaredNorm();
  } else {
    const double residual_m = surface.normal.dot(offset_m);
    sums.squared_residuals_m2 += residual_m * residual_m;
  }
}

std::span<const double> FitProfile::fits_at(const std::vector<MatchPoint>& points,
                                            const grids::SurfelMap& surfels, double heading_rad,
                                            std::span<const Vector2> positions_m,
                                            const PointToLineConfig& config) {
  const double gate_m = config.fine_gate_m;
  const int radius = search_radius(surfels, gate_m);
  const geometry::Matrix2 turn = geometry::rotation(heading_rad);
  sums_.assign(positions_m.size(), {});
  for (const MatchPoint& point : points) {
    const Vector2 turned_m = turn * point.in_base_m;
    SurfacesAround around(surfels, radius);
    for (std::size_t i = 0; i < positions_m.size(); ++i) {
      const Vector2 at_m = turned_m + positions_m[i];
      const std::size_t place = around.nearest_place(at_m);
      if (place == grids::SurfelMap::kNoPlace) continue;
      const Vector2 offset_m = at_m - surfels.mean_at(place);
      if (offset_m.squaredNorm() > gate_m * gate_m) continue;
      add(surfels.surface_at(place), offset_m, sums_[i]);
    }
  }
  fits_.clear();
  for (const Sums& sums : sums_) {
    const double matched = sums.matched;
    fits_.push_back(sums.matched == 0 ? 0.0
                                      : fit_of(matched / static_cast<double>(points.size()),
                                               std::sqrt(sums.squared_residuals_m2 / matched),
                                               config.robust_scale_m));
  }
  return fits_;
}

}  // namespace slammot::matching
