#include "common/city_model/facades.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <Eigen/Eigenvalues>

namespace slammot::city_model {
namespace {

using geometry::Matrix2;
using geometry::Vector2;

constexpr std::size_t kFewestEchoes = 15;  ///< Fewer are a part of a far or grazing surface.
constexpr double kNearRoad_m = 0.8;
constexpr double kLeastWidth_m = 0.05;
constexpr double kLineRatio = 0.08;    ///< Greatest variance across a line, over that along it.
constexpr double kLineSigma_m = 0.12;  ///< Shorter ones are poles.

Vector2 in_plane(const PlacedEcho& echo) { return echo.position_in_map_m.head<2>().cast<double>(); }

struct Moments {
  double count = 0.0;
  Vector2 sum = Vector2::Zero();
  Matrix2 squares = Matrix2::Zero();

  void add(const std::vector<PlacedEcho>& echoes, const Vector2& origin_m) {
    for (const PlacedEcho& echo : echoes) {
      const Vector2 point = in_plane(echo) - origin_m;
      count += 1.0;
      sum += point;
      squares += point * point.transpose();
    }
  }
  Vector2 mean() const { return sum / count; }
  Matrix2 covariance() const { return squares / count - mean() * mean().transpose(); }
};

/// Part of the line through a point, relative to the cell's lower corner, that lies in the cell.
std::array<Vector2, 2> clipped(const Vector2& point, const Vector2& direction, double cell_size_m) {
  double from = -std::numeric_limits<double>::infinity();
  double to = -from;
  for (const Eigen::Index axis : {0, 1}) {
    if (std::abs(direction[axis]) < 1e-9) continue;
    const double low = -point[axis] / direction[axis];
    const double high = (cell_size_m - point[axis]) / direction[axis];
    from = std::max(from, std::min(low, high));
    to = std::min(to, std::max(low, high));
  }
  return {Vector2(point + from * direction), Vector2(point + to * direction)};
}

std::array<Vector2, 2> ground_line(const Columns& columns, const Columns::value_type& column,
                                   double cell_size_m) {
  const auto& [cell, echoes] = column;
  const Vector2 corner_m = cell_size_m * Vector2(cell.first, cell.second);
  Moments own, around;
  own.add(echoes, corner_m);
  for (const int x : {-1, 0, 1}) {
    for (const int y : {-1, 0, 1}) {
      const auto neighbour = columns.find({cell.first + x, cell.second + y});
      if (neighbour != columns.end()) around.add(neighbour->second, corner_m);
    }
  }
  const Eigen::SelfAdjointEigenSolver<Matrix2> axes(around.covariance());
  const double across = axes.eigenvalues()[0];
  const double along = axes.eigenvalues()[1];
  const Vector2 direction = axes.eigenvectors().col(1);
  if (across < kLineRatio * along && along > kLineSigma_m * kLineSigma_m) {
    const auto ends = clipped(own.mean(), direction, cell_size_m);
    return {Vector2(corner_m + ends[0]), Vector2(corner_m + ends[1])};
  }
  const double variance = std::max(0.0, direction.dot(own.covariance() * direction));
  const double half_m = std::max(0.5 * kLeastWidth_m, std::sqrt(3.0 * variance));
  return {Vector2(corner_m + own.mean() - half_m * direction),
          Vector2(corner_m + own.mean() + half_m * direction)};
}

}  // namespace

Cell cell_of(const Eigen::Vector3f& position_in_map_m, double cell_size_m) {
  const auto index = [&](float value) {
    return static_cast<int>(std::floor(static_cast<double>(value) / cell_size_m));
  };
  return {index(position_in_map_m.x()), index(position_in_map_m.y())};
}

Span span_of(std::span<const PlacedEcho> echoes) {
  constexpr std::size_t kOthers = 2;  // within kNear_m
  constexpr double kNear_m = 1.0;
  std::vector<double> heights_m;
  for (const PlacedEcho& echo : echoes)
    heights_m.push_back(static_cast<double>(echo.position_in_map_m.z()));
  std::ranges::sort(heights_m);
  if (heights_m.size() <= kOthers) return {heights_m.front(), heights_m.back()};
  std::size_t bottom = 0;
  std::size_t top = heights_m.size() - 1;
  while (top > kOthers && heights_m[top] - heights_m[top - kOthers] > kNear_m) --top;
  while (bottom + kOthers < top && heights_m[bottom + kOthers] - heights_m[bottom] > kNear_m)
    ++bottom;
  return {heights_m[bottom], heights_m[top]};
}

std::vector<Facade> facades_of(const Columns& columns, double cell_size_m) {
  std::vector<Facade> facades;
  for (const Columns::value_type& column : columns) {
    if (column.second.size() < kFewestEchoes) continue;
    const Span span = span_of(column.second);
    const auto [from_m, to_m] = ground_line(columns, column, cell_size_m);
    facades.push_back(
        {from_m, to_m, span.bottom_m < kNearRoad_m ? 0.0 : span.bottom_m, span.top_m});
  }
  return facades;
}

}  // namespace slammot::city_model
