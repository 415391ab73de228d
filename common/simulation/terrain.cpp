#include "common/simulation/terrain.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "common/simulation/piecewise_linear.hpp"

namespace slammot::simulation {

using geometry::Vector2;

double Terrain::height_m(double x_m) const {
  return piecewise_linear(heights_, &HeightAt::x_m, &HeightAt::z_m, x_m);
}

double Terrain::nose_down_rad(const geometry::Pose2& world_from_body) const {
  constexpr double kAxle_m = 1.4;
  const double reach_m = kAxle_m * std::cos(world_from_body.heading_rad);
  return std::atan2(
      height_m(world_from_body.x_m - reach_m) - height_m(world_from_body.x_m + reach_m),
      2.0 * kAxle_m);
}

double Terrain::distance_to_ground(const Vector2& origin_in_world,
                                   const Vector2& direction_in_world, double origin_z_m,
                                   double rise) const {
  // Between two changes of slope both the ray and the road are straight.
  std::vector<double> changes_m;
  for (const HeightAt& height : heights_) {
    const double ahead_m = (height.x_m - origin_in_world.x()) / direction_in_world.x();
    if (direction_in_world.x() != 0.0 && ahead_m > 0.0) changes_m.push_back(ahead_m);
  }
  std::sort(changes_m.begin(), changes_m.end());
  const auto clearance_m = [&](double ahead_m) {
    return origin_z_m + rise * ahead_m -
           height_m(origin_in_world.x() + ahead_m * direction_in_world.x());
  };
  double from_m = 0.0;
  double above_m = clearance_m(0.0);
  for (const double to_m : changes_m) {
    const double there_m = clearance_m(to_m);
    if (there_m <= 0.0) return from_m + (to_m - from_m) * above_m / (above_m - there_m);
    from_m = to_m;
    above_m = there_m;
  }
  return rise < 0.0 ? from_m + above_m / -rise : std::numeric_limits<double>::infinity();
}

}  // namespace slammot::simulation
