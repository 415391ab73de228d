#include "common/simulation/ray_caster.hpp"

#include <algorithm>
#include <cmath>

namespace slammot::simulation {
namespace {

using geometry::Vector2;

struct Box {
  Vector2 low{kInfinity, kInfinity};
  Vector2 high{-kInfinity, -kInfinity};

  void include(const Vector2& point) {
    low = low.cwiseMin(point);
    high = high.cwiseMax(point);
  }
};

Box box_of(const Segment& segment) {
  Box box;
  box.include(segment.a);
  box.include(segment.b);
  return box;
}

Box box_of(const Circle& circle) {
  const Vector2 radius{circle.radius_m, circle.radius_m};
  return {circle.centre - radius, circle.centre + radius};
}

bool touches(const Segment& segment, const Vector2& cell_centre, double cell_m) {
  const Vector2 along = segment.b - segment.a;
  const Vector2 normal{-along.y(), along.x()};
  const double reach = 0.5 * cell_m * (std::abs(normal.x()) + std::abs(normal.y()));
  return std::abs(normal.dot(cell_centre - segment.a)) <= reach * (1.0 + 1e-9);
}

bool touches(const Circle&, const Vector2&, double) { return true; }  // its box is tight enough

/// Distances along one axis of a grid walk: to the next cell border and between borders.
struct AxisWalk {
  int step = 0;
  double to_border_m = kInfinity;
  double between_borders_m = kInfinity;

  AxisWalk(double origin, double direction, int cell, double cell_m) {
    if (direction == 0.0) return;
    step = direction > 0.0 ? 1 : -1;
    const double border = cell_m * (cell + (step > 0 ? 1 : 0));
    to_border_m = (border - origin) / direction;
    between_borders_m = cell_m / std::abs(direction);
  }
};

}  // namespace

RayCaster::RayCaster(const Outline& outline_in_world, double cell_m) : cell_m_(cell_m) {
  Box box;
  for (const Segment& segment : outline_in_world.segments) {
    box.include(segment.a);
    box.include(segment.b);
  }
  for (const Circle& circle : outline_in_world.circles) {
    box.include(box_of(circle).low);
    box.include(box_of(circle).high);
  }
  if (box.low.x() > box.high.x()) return;  // an empty world: every ray misses
  // One cell of margin, so that rounding at the edge never leaves the grid.
  corner_in_world_ = box.low - Vector2{cell_m, cell_m};
  columns_ = static_cast<int>((box.high.x() - corner_in_world_.x()) / cell_m) + 2;
  rows_ = static_cast<int>((box.high.y() - corner_in_world_.y()) / cell_m) + 2;
  fill_cells(outline_in_world);
}

void RayCaster::fill_cells(const Outline& outline_in_world) {
  const auto visit_cells_of = [this](const auto& surface, auto&& visit) {
    const Box box = box_of(surface);
    const Eigen::Vector2i low =
        ((box.low - corner_in_world_) / cell_m_).array().floor().cast<int>();
    const Eigen::Vector2i high =
        ((box.high - corner_in_world_) / cell_m_).array().floor().cast<int>();
    for (int row = low.y(); row <= high.y(); ++row) {
      for (int column = low.x(); column <= high.x(); ++column) {
        const Vector2 centre = corner_in_world_ + cell_m_ * Vector2{column + 0.5, row + 0.5};
        if (touches(surface, centre, cell_m_))
          visit(static_cast<std::size_t>(row * columns_ + column));
      }
    }
  };
  std::vector<std::vector<Segment>> segments(static_cast<std::size_t>(columns_ * rows_));
  std::vector<std::vector<Circle>> circles(segments.size());
  for (const Segment& segment : outline_in_world.segments) {
    visit_cells_of(segment, [&](std::size_t cell) { segments[cell].push_back(segment); });
  }
  for (const Circle& circle : outline_in_world.circles) {
    visit_cells_of(circle, [&](std::size_t cell) { circles[cell].push_back(circle); });
  }
  cells_.reserve(segments.size());
  for (std::size_t i = 0; i < segments.size(); ++i) {
    cells_.push_back({static_cast<std::uint32_t>(segments_by_cell_.size()),
                      static_cast<std::uint32_t>(segments[i].size()),
                      static_cast<std::uint32_t>(circles_by_cell_.size()),
                      static_cast<std::uint32_t>(circles[i].size())});
    segments_by_cell_.insert(segments_by_cell_.end(), segments[i].begin(), segments[i].end());
    circles_by_cell_.insert(circles_by_cell_.end(), circles[i].begin(), circles[i].end());
  }
}

void RayCaster::test_cell(const Cell& cell, const Vector2& origin_in_world,
                          const Vector2& direction_in_world, Hit& nearest) const {
  const auto test = [&](const auto& surface) {
    const double range_m = distance_along_ray(surface, origin_in_world, direction_in_world);
    if (range_m < nearest.range_m) nearest = {range_m, surface.material};
  };
  for (std::uint32_t i = 0; i < cell.segment_count; ++i)
    test(segments_by_cell_[cell.first_segment + i]);
  for (std::uint32_t i = 0; i < cell.circle_count; ++i)
    test(circles_by_cell_[cell.first_circle + i]);
}

Hit RayCaster::cast(const Vector2& origin_in_world, const Vector2& direction_in_world,
                    double max_range_m) const {
  Hit nearest;
  if (columns_ == 0) return nearest;
  // A ray from outside enters where it meets the grid's box.
  const Vector2 size{columns_ * cell_m_, rows_ * cell_m_};
  double enter_m = 0.0;
  double leave_m = max_range_m;
  const Vector2 origin = origin_in_world - corner_in_world_;
  for (int axis = 0; axis < 2; ++axis) {
    if (direction_in_world[axis] == 0.0) {
      if (origin[axis] < 0.0 || origin[axis] >= size[axis]) return nearest;
      continue;
    }
    const double first = -origin[axis] / direction_in_world[axis];
    const double second = (size[axis] - origin[axis]) / direction_in_world[axis];
    enter_m = std::max(enter_m, std::min(first, second));
    leave_m = std::min(leave_m, std::max(first, second));
  }
  if (enter_m > leave_m) return nearest;

  const Vector2 entry = origin + enter_m * direction_in_world;
  int column = std::clamp(static_cast<int>(entry.x() / cell_m_), 0, columns_ - 1);
  int row = std::clamp(static_cast<int>(entry.y() / cell_m_), 0, rows_ - 1);
  AxisWalk along_x{origin.x(), direction_in_world.x(), column, cell_m_};
  AxisWalk along_y{origin.y(), direction_in_world.y(), row, cell_m_};
  while (column >= 0 && column < columns_ && row >= 0 && row < rows_) {
    test_cell(cells_[static_cast<std::size_t>(row * columns_ + column)], origin_in_world,
              direction_in_world, nearest);
    const double border_m = std::min(along_x.to_border_m, along_y.to_border_m);
    if (nearest.range_m <= border_m || border_m > leave_m) break;  // a nearer surface cannot follow
    if (along_x.to_border_m < along_y.to_border_m) {
      column += along_x.step;
      along_x.to_border_m += along_x.between_borders_m;
    } else {
      row += along_y.step;
      along_y.to_border_m += along_y.between_borders_m;
    }
  }
  return nearest.range_m <= max_range_m ? nearest : Hit{};
}

}  // namespace slammot::simulation
