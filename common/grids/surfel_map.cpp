#include "common/grids/surfel_map.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

namespace slammot::grids {
namespace {

double seen_over_m(const CellMoments& moments) {
  if (moments.first_seen_at_m <= 0.0F) return std::numeric_limits<double>::infinity();
  return static_cast<double>(moments.last_seen_at_m) - static_cast<double>(moments.first_seen_at_m);
}

}  // namespace

SurfelMap::SurfelMap(const GridWindow& window, double weight_limit)
    : window_(window), weight_limit_(static_cast<float>(weight_limit)), slots_(window.cell_count(), -1) {}

std::int32_t SurfelMap::make_slot(Cell cell) {
  std::int32_t& slot = slots_[window_.index(cell)];
  if (slot < 0) {
    slot = static_cast<std::int32_t>(moments_.size());
    moments_.emplace_back();
    cells_.push_back(cell);
    shapes_.emplace_back();
  }
  return slot;
}

void SurfelMap::mark_stale_around(Cell cell) {
  for (std::int32_t row = cell.row - 1; row <= cell.row + 1; ++row) {
    for (std::int32_t column = cell.column - 1; column <= cell.column + 1; ++column) {
      const std::int32_t slot = slot_of({column, row});
      if (slot >= 0) shapes_[static_cast<std::size_t>(slot)].stale = true;
    }
  }
}

void SurfelMap::add(const Eigen::Vector2d& point_m, double odometer_m) {
  const Cell cell = window_.cell_at(point_m.x(), point_m.y());
  if (!window_.contains(cell)) return;
  CellMoments& moments = moments_[static_cast<std::size_t>(make_slot(cell))];
  if (moments.weight <= 0.0F) moments.first_seen_at_m = static_cast<float>(odometer_m);
  moments.last_seen_at_m = static_cast<float>(odometer_m);
  if (moments.weight >= weight_limit_) {
    const float keep = (weight_limit_ - 1.0F) / moments.weight;
    for (float* sum : {&moments.weight, &moments.x, &moments.y, &moments.xx, &moments.xy, &moments.yy}) *sum *= keep;
  }
  const Eigen::Vector2f offset = (point_m - window_.centre_of(cell)).cast<float>();
  moments.weight += 1.0F;
  moments.x += offset.x();
  moments.y += offset.y();
  moments.xx += offset.x() * offset.x();
  moments.xy += offset.x() * offset.y();
  moments.yy += offset.y() * offset.y();
  moments.own_echoes += 1.0F;
  mark_stale_around(cell);
}

void SurfelMap::erase(Cell cell) {
  const std::int32_t slot = slot_of(cell);
  if (is_empty(slot)) return;
  moments_[static_cast<std::size_t>(slot)] = CellMoments{};
  mark_stale_around(cell);
}

Eigen::Vector2d SurfelMap::mean_of(std::int32_t slot) const {
  const auto place = static_cast<std::size_t>(slot);
  const CellMoments& moments = moments_[place];
  return window_.centre_of(cells_[place]) + Eigen::Vector2d(moments.x, moments.y) / static_cast<double>(moments.weight);
}

SurfelMap::Shape SurfelMap::shape_at(Cell cell) const {
  const double size_m = window_.cell_size_m;
  double weight = 0.0, x = 0.0, y = 0.0, xx = 0.0, xy = 0.0, yy = 0.0;
  for (std::int32_t row = -1; row <= 1; ++row) {
    for (std::int32_t column = -1; column <= 1; ++column) {
      const std::int32_t slot = slot_of({cell.column + column, cell.row + row});
      if (is_empty(slot)) continue;
      const CellMoments& m = moments_[static_cast<std::size_t>(slot)];
      // The square root: the direction of a surface is a matter of where it was seen, less of how often.
      const double share = 1.0 / std::sqrt(static_cast<double>(m.weight));
      const double n = m.weight * share, dx = column * size_m, dy = row * size_m, sx = m.x * share, sy = m.y * share;
      weight += n;
      x += sx + n * dx;
      y += sy + n * dy;
      xx += m.xx * share + 2.0 * dx * sx + n * dx * dx;
      xy += m.xy * share + dx * sy + dy * sx + n * dx * dy;
      yy += m.yy * share + 2.0 * dy * sy + n * dy * dy;
    }
  }
  const double cxx = xx / weight - (x / weight) * (x / weight);
  const double cyy = yy / weight - (y / weight) * (y / weight);
  const double cxy = xy / weight - (x / weight) * (y / weight);
  // Eigenvalues of the symmetric 2 x 2 covariance.
  const double half_trace = 0.5 * (cxx + cyy);
  const double root = std::sqrt(0.25 * (cxx - cyy) * (cxx - cyy) + cxy * cxy);
  const double large = half_trace + root;
  const double small = std::max(0.0, half_trace - root);
  Shape shape{0.0F, 0.0F, static_cast<float>(small), false};
  const double least_extent_m = 0.25 * size_m;
  if (large < least_extent_m * least_extent_m || small > 0.25 * large) return shape;  // a dot or a blob: no direction
  const double angle = 0.5 * std::atan2(2.0 * cxy, cxx - cyy);                        // of the larger axis
  shape.normal_x = static_cast<float>(-std::sin(angle));
  shape.normal_y = static_cast<float>(std::cos(angle));
  return shape;
}

SurfelView SurfelMap::view_of(std::int32_t slot) const {
  const auto place = static_cast<std::size_t>(slot);
  if (shapes_[place].stale) shapes_[place] = shape_at(cells_[place]);
  const Shape& shape = shapes_[place];
  return {cells_[place], mean_of(slot), {shape.normal_x, shape.normal_y}, shape.spread_m2, moments_[place].weight,
          moments_[place].own_echoes, seen_over_m(moments_[place])};
}

std::int32_t SurfelMap::nearest_slot(const Eigen::Vector2d& point_m, int radius) const {
  const Cell centre = window_.cell_at(point_m.x(), point_m.y());
  double best_m2 = std::numeric_limits<double>::infinity();
  std::int32_t best_slot = -1;
  for (std::int32_t row = centre.row - radius; row <= centre.row + radius; ++row) {
    for (std::int32_t column = centre.column - radius; column <= centre.column + radius; ++column) {
      const std::int32_t slot = slot_of({column, row});
      if (is_empty(slot)) continue;
      const double distance_m2 = (mean_of(slot) - point_m).squaredNorm();
      if (distance_m2 >= best_m2) continue;
      best_m2 = distance_m2;
      best_slot = slot;
    }
  }
  return best_slot;
}

std::optional<SurfelView> SurfelMap::nearest(const Eigen::Vector2d& point_m, int radius) const {
  std::int32_t slot = nearest_slot(point_m, 1);
  if (slot < 0 && radius > 1) slot = nearest_slot(point_m, radius);
  if (slot < 0) return std::nullopt;
  return view_of(slot);
}

std::vector<SurfelView> SurfelMap::all() const {
  std::vector<SurfelView> surfels;
  surfels.reserve(moments_.size());
  for (std::size_t place = 0; place < moments_.size(); ++place) {
    const auto slot = static_cast<std::int32_t>(place);
    if (!is_empty(slot)) surfels.push_back(view_of(slot));
  }
  return surfels;
}

SurfelMap SurfelMap::moved_to(const GridWindow& window) const {
  assert(window.cell_size_m == window_.cell_size_m);
  SurfelMap moved(window, weight_limit_);
  moved.moments_.reserve(moments_.size());
  moved.cells_.reserve(moments_.size());
  moved.shapes_.reserve(moments_.size());
  for (std::size_t place = 0; place < moments_.size(); ++place) {
    if (is_empty(static_cast<std::int32_t>(place)) || !window.contains(cells_[place])) continue;
    CellMoments moments = moments_[place];
    moments.own_echoes = 0.0F;
    moved.moments_[static_cast<std::size_t>(moved.make_slot(cells_[place]))] = moments;
  }
  return moved;
}

const CellMoments* SurfelMap::moments_at(Cell cell) const {
  const std::int32_t slot = slot_of(cell);
  return is_empty(slot) ? nullptr : &moments_[static_cast<std::size_t>(slot)];
}

void SurfelMap::set_moments(Cell cell, const CellMoments& moments) {
  if (!window_.contains(cell)) return;
  moments_[static_cast<std::size_t>(make_slot(cell))] = moments;
  mark_stale_around(cell);
}

}  // namespace slammot::grids
