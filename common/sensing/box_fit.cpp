#include "common/sensing/box_fit.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

namespace slammot::sensing {
namespace {

constexpr double kHalfPi = 0.5 * std::numbers::pi;
constexpr std::size_t kMostPointsWeighed = 48;  ///< Larger segments are subsampled:
                                                ///< tests/bench/detector_bench.cpp.

struct Extent {
  double least = std::numeric_limits<double>::max();
  double most = std::numeric_limits<double>::lowest();
  void include(double value) { least = std::min(least, value), most = std::max(most, value); }
};

struct Echoes {
  std::span<const Eigen::Vector2d> points_m;
  std::size_t stride = 1;  ///< Stride of the subsampling.
  double range_noise_m = 0.0;
};

/// Closeness score: sum over the points of the inverse distance to the nearest side of the tightest
/// box.
double closeness(const Echoes& echoes, double heading_rad) {
  const auto& [points_m, stride, range_noise_m] = echoes;
  const double c = std::cos(heading_rad);
  const double s = std::sin(heading_rad);
  std::array<double, 2 * kMostPointsWeighed> along;
  std::array<double, 2 * kMostPointsWeighed> across;
  Extent length, width;
  std::size_t count = 0;
  for (std::size_t i = 0; i < points_m.size(); i += stride) {
    along[count] = c * points_m[i].x() + s * points_m[i].y();
    across[count] = -s * points_m[i].x() + c * points_m[i].y();
    length.include(along[count]);
    width.include(across[count++]);
  }
  double sum = 0.0;
  for (std::size_t i = 0; i < count; ++i) {
    const double to_end = std::min(along[i] - length.least, length.most - along[i]);
    const double to_side = std::min(across[i] - width.least, width.most - across[i]);
    sum += 1.0 / std::max(range_noise_m, std::min(to_end, to_side));
  }
  return sum;
}

double best_heading(const Echoes& echoes, double from_rad, double step_rad, int steps) {
  double best = from_rad;
  double best_closeness = -1.0;
  for (int i = 0; i < steps; ++i) {
    const double heading_rad = from_rad + i * step_rad;
    const double value = closeness(echoes, heading_rad);
    if (value > best_closeness) best_closeness = value, best = heading_rad;
  }
  return best;
}

double wrap_axis(double heading_rad) {
  const double wrapped = std::remainder(heading_rad, std::numbers::pi);
  return wrapped <= -kHalfPi ? kHalfPi : wrapped;
}

}  // namespace

BoxSides::BoxSides(const OrientedBox& box)
    : centre_m_(box.centre_m),
      along_(std::cos(box.heading_rad), std::sin(box.heading_rad)),
      half_size_m_(0.5 * box.length_m, 0.5 * box.width_m) {}

double BoxSides::distance_m(const Eigen::Vector2d& point_m) const {
  const Eigen::Vector2d across{-along_.y(), along_.x()};
  const Eigen::Vector2d off_m = point_m - centre_m_;
  const Eigen::Vector2d inside_m =
      half_size_m_ - Eigen::Vector2d(std::abs(along_.dot(off_m)), std::abs(across.dot(off_m)));
  return inside_m.minCoeff() >= 0.0 ? inside_m.minCoeff() : inside_m.cwiseMin(0.0).norm();
}

OrientedBox box_at_heading(std::span<const Eigen::Vector2d> points_m, double heading_rad) {
  const Eigen::Vector2d along{std::cos(heading_rad), std::sin(heading_rad)};
  const Eigen::Vector2d across{-along.y(), along.x()};
  Extent length, width;
  for (const Eigen::Vector2d& point : points_m) {
    length.include(along.dot(point));
    width.include(across.dot(point));
  }
  OrientedBox box;
  box.centre_m =
      0.5 * (length.least + length.most) * along + 0.5 * (width.least + width.most) * across;
  box.length_m = length.most - length.least;
  box.width_m = width.most - width.least;
  if (box.width_m > box.length_m) {
    std::swap(box.length_m, box.width_m);
    heading_rad += kHalfPi;
  }
  box.heading_rad = wrap_axis(heading_rad);
  return box;
}

OrientedBox fit_box(std::span<const Eigen::Vector2d> points_m, double range_noise_m) {
  if (points_m.size() < 3) {
    const Eigen::Vector2d way = points_m.back() - points_m.front();
    return box_at_heading(points_m, std::atan2(way.y(), way.x()));
  }
  constexpr double kCoarseRad = 6.0 * std::numbers::pi / 180.0;
  constexpr double kFineRad = 1.5 * std::numbers::pi / 180.0;
  const Echoes echoes{points_m, 1 + (points_m.size() - 1) / kMostPointsWeighed, range_noise_m};
  const double coarse = best_heading(echoes, 0.0, kCoarseRad, 15);
  const double fine = best_heading(echoes, coarse - 3.0 * kFineRad, kFineRad, 7);
  return box_at_heading(points_m, fine);
}

}  // namespace slammot::sensing
