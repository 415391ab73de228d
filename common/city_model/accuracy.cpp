#include "common/city_model/accuracy.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "common/geometry/order_statistics.hpp"
#include "common/geometry/segment.hpp"

namespace slammot::city_model {
namespace {

using geometry::Vector2;

double distance_m(const TrueSurface& surface, const Vector2& point) {
  return (geometry::nearest_on_segment(surface.from_m, surface.to_m, point) - point).norm();
}

struct Nearest {
  const TrueSurface* surface = nullptr;
  double distance_m = kAstray_m;
};

/// Finds surfaces by square tiles, each with what comes within kAstray_m of it.
class SurfaceIndex {
 public:
  explicit SurfaceIndex(const std::vector<TrueSurface>& surfaces) {
    for (const TrueSurface& surface : surfaces) add(surface);
  }

  Nearest nearest(const Vector2& point) const {
    Nearest best;
    const auto tile = tiles_.find({index(point.x()), index(point.y())});
    if (tile == tiles_.end()) return best;
    for (const TrueSurface* surface : tile->second) {
      const double away_m = distance_m(*surface, point);
      if (away_m < best.distance_m) best = {surface, away_m};
    }
    return best;
  }

 private:
  static constexpr double kTile_m = 4.0;

  static int index(double value_m) { return static_cast<int>(std::floor(value_m / kTile_m)); }

  void add(const TrueSurface& surface) {
    const Vector2 reach = Vector2::Constant(kAstray_m);
    const Vector2 low = surface.from_m.cwiseMin(surface.to_m) - reach;
    const Vector2 high = surface.from_m.cwiseMax(surface.to_m) + reach;
    for (int x = index(low.x()); x <= index(high.x()); ++x) {
      for (int y = index(low.y()); y <= index(high.y()); ++y) {
        const Vector2 centre = kTile_m * Vector2(x + 0.5, y + 0.5);
        if (distance_m(surface, centre) <= kTile_m + kAstray_m) tiles_[{x, y}].push_back(&surface);
      }
    }
  }

  std::map<Cell, std::vector<const TrueSurface*>> tiles_;
};

}  // namespace

ModelAccuracy judge(const CityModel& model, const ModelTruth& truth) {
  constexpr double kOnWall_m = 0.3;
  const SurfaceIndex index(truth.surfaces);
  ModelAccuracy accuracy;
  std::vector<double> distances_m;
  std::size_t astray = 0;
  for (const PlacedEcho& point : model.points) {
    const Vector2 in_world =
        truth.world_from_map * Vector2(point.position_in_map_m.head<2>().cast<double>());
    const Nearest nearest = index.nearest(in_world);
    distances_m.push_back(nearest.distance_m);
    astray += nearest.surface == nullptr ? 1 : 0;
  }
  std::vector<double> tops_m, absolute_m;
  for (const Facade& facade : model.facades) {
    const Vector2 middle = truth.world_from_map * Vector2(0.5 * (facade.from_m + facade.to_m));
    const Nearest nearest = index.nearest(middle);
    if (nearest.surface == nullptr || !nearest.surface->is_wall || nearest.distance_m > kOnWall_m)
      continue;
    tops_m.push_back(facade.top_m - nearest.surface->height_m);
    absolute_m.push_back(std::abs(tops_m.back()));
  }
  const auto share = [&](std::size_t count) {
    return model.points.empty()
               ? 0.0
               : static_cast<double>(count) / static_cast<double>(model.points.size());
  };
  accuracy.point_distance_m = metrics::summarize(std::move(distances_m));
  accuracy.astray_share = share(astray);
  accuracy.wall_top_error_m = metrics::summarize(std::move(absolute_m));
  accuracy.wall_top_bias_m = geometry::upper_median(std::move(tops_m));
  accuracy.residue_share =
      share(static_cast<std::size_t>(std::ranges::count(truth.is_of_mover, std::uint8_t{1})));
  return accuracy;
}

}  // namespace slammot::city_model
