#include "common/city_model/road_height.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace slammot::city_model {
namespace {

constexpr double kBeside_m = 6.0;     ///< Farther away a slope across the road matters.
constexpr double kFromBase_m = 1.0;   ///< Greatest height of the base above the road.
constexpr double kThickness_m = 0.2;  ///< Of the densest layer: the road with its noise.
constexpr std::ptrdiff_t kFewest = 10;
constexpr double kGain = 0.1;  ///< Share of a scan in the estimate.

}  // namespace

void RoadHeight::add(std::span<const Eigen::Vector3d> points_in_base_m) {
  heights_m_.clear();
  for (const Eigen::Vector3d& point_m : points_in_base_m) {
    if (std::abs(point_m.y()) < kBeside_m && std::abs(point_m.z()) < kFromBase_m)
      heights_m_.push_back(point_m.z());
  }
  std::ranges::sort(heights_m_);
  std::ptrdiff_t most = 0;
  double densest_m = 0.0;
  for (auto first = heights_m_.begin(); first != heights_m_.end(); ++first) {
    const auto end = std::upper_bound(first, heights_m_.end(), *first + kThickness_m);
    if (end - first <= most) continue;
    most = end - first;
    densest_m = *(first + most / 2);
  }
  if (most < kFewest) return;
  height_m_ += (is_known_ ? kGain : 1.0) * (densest_m - height_m_);
  is_known_ = true;
}

}  // namespace slammot::city_model
