#include "common/grids/surfel_map.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

namespace slammot::grids {
namespace {

const Eigen::Vector2d kNowhere = Eigen::Vector2d::Constant(std::numeric_limits<double>::infinity());

double seen_over_m(const CellMoments& moments) {
  if (moments.first_seen_at_m <= 0.0F) return std::numeric_limits<double>::infinity();
  return static_cast<double>(moments.last_seen_at_m) - static_cast<double>(moments.first_seen_at_m);
}

}  // namespace

SurfelMap::SurfelMap(const GridWindow& window, double weight_limit)
    : window_(window), weight_limit_(static_cast<float>(weight_limit)), slots_(window.cell_count(), -1), means_m_{kNowhere} {}

std::int32_t SurfelMap::make_slot(Cell cell) {
  std::int32_t& slot = slots_[window_.index(cell)];
  if (slot < 0) {
    slot = static_cast<std::int32_t>(moments_.size());
    moments_.emplace_back();
    cells_.push_back(cell);
    means_m_.push_back(kNowhere);
    shares_.push_back(0.0);
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

void SurfelMap::add_to_moments(std::size_t place, const Eigen::Vector2d& point_m, float odometer_m) {
  CellMoments& moments = moments_[place];
  if (moments.weight <= 0.0F) moments.first_seen_at_m = odometer_m;
  moments.last_seen_at_m = odometer_m;
  if (moments.weight >= weight_limit_) {
    const float keep = (weight_limit_ - 1.0F) / moments.weight;
    for (float* sum : {&moments.weight, &moments.x, &moments.y, &moments.xx, &moments.xy, &moments.yy}) *sum *= keep;
  }
  const Eigen::Vector2f offset = (point_m - window_.centre_of(cells_[place])).cast<float>();
  moments.weight += 1.0F;
  moments.x += offset.x();
  moments.y += offset.y();
  moments.xx += offset.x() * offset.x();
  moments.xy += offset.x() * offset.y();
  moments.yy += offset.y() * offset.y();
  moments.own_echoes += 1.0F;
}

void SurfelMap::add_all(std::span<const Eigen::Vector2d> points_m, double odometer_m) {
  std::optional<std::size_t> changed;   // of which the moments are not all yet
  const auto conclude = [&] {
    if (!changed) return;
    note_mean(*changed);
    mark_stale_around(cells_[*changed]);
  };
  for (const Eigen::Vector2d& point_m : points_m) {
    const Cell cell = window_.cell_at(point_m.x(), point_m.y());
    if (!window_.contains(cell)) continue;
    if (!changed || cells_[*changed] != cell) {
      conclude();
      changed = static_cast<std::size_t>(make_slot(cell));
    }
    add_to_moments(*changed, point_m, static_cast<float>(odometer_m));
  }
  conclude();
}

void SurfelMap::erase(Cell cell) {
  const std::int32_t slot = slot_of(cell);
  if (is_empty(slot)) return;
  moments_[static_cast<std::size_t>(slot)] = CellMoments{};
  note_mean(static_cast<std::size_t>(slot));
  mark_stale_around(cell);
}

void SurfelMap::note_mean(std::size_t place) {
  const CellMoments& moments = moments_[place];
  const bool is_anywhere = moments.weight > 0.0F;
  // The square root: the direction of a surface is a matter of where it was seen, less of how often.
  shares_[place] = is_anywhere ? 1.0 / std::sqrt(static_cast<double>(moments.weight)) : 0.0;
  means_m_[place + 1] = is_anywhere ? window_.centre_of(cells_[place]) + Eigen::Vector2d(moments.x, moments.y) / static_cast<double>(moments.weight) : kNowhere;
}

SurfelMap::Shape SurfelMap::shape_at(Cell cell) const {
  const double size_m = window_.cell_size_m;
  double weight = 0.0, x = 0.0, y = 0.0, xx = 0.0, xy = 0.0, yy = 0.0;
  const bool is_inside = window_.contains({cell.column - 1, cell.row - 1}) && window_.contains({cell.column + 1, cell.row + 1});
  for (std::int32_t row = -1; row <= 1; ++row) {
    for (std::int32_t column = -1; column <= 1; ++column) {
      const Cell neighbour{cell.column + column, cell.row + row};
      const std::int32_t slot = is_inside ? slots_[window_.index(neighbour)] : slot_of(neighbour);
      if (slot < 0) continue;
      const CellMoments& m = moments_[static_cast<std::size_t>(slot)];
      const double share = shares_[static_cast<std::size_t>(slot)];
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
  // Sine and cosine of half the angle whose tangent is 2 cxy / (cxx - cyy): the direction of the larger axis.
  const double cosine_of_twice = root > 0.0 ? 0.5 * (cxx - cyy) / root : 1.0;
  shape.normal_x = static_cast<float>(-std::copysign(std::sqrt(std::max(0.0, 0.5 * (1.0 - cosine_of_twice))), cxy));
  shape.normal_y = static_cast<float>(std::sqrt(std::max(0.0, 0.5 * (1.0 + cosine_of_twice))));
  return shape;
}

const SurfelMap::Shape& SurfelMap::fresh_shape(std::size_t place) const {
  if (shapes_[place].stale) shapes_[place] = shape_at(cells_[place]);
  return shapes_[place];
}

SurfelView SurfelMap::view_of(std::int32_t slot) const {
  const auto place = static_cast<std::size_t>(slot);
  const Shape& shape = fresh_shape(place);
  return {cells_[place], mean_m(slot), {shape.normal_x, shape.normal_y}, shape.spread_m2, moments_[place].weight,
          moments_[place].own_echoes, seen_over_m(moments_[place])};
}

std::int32_t SurfelMap::nearest_slot(const Eigen::Vector2d& point_m, int radius) const {
  const Cell centre = window_.cell_at(point_m.x(), point_m.y());
  const auto clamped = [](std::int64_t place, std::int32_t first, std::int32_t count) {  // wide: points may be anywhere
    return static_cast<std::int32_t>(std::clamp<std::int64_t>(place - first, 0, count));
  };
  const std::int32_t first_column = clamped(std::int64_t{centre.column} - radius, window_.first.column, window_.columns);
  const std::int32_t end_column = clamped(std::int64_t{centre.column} + radius + 1, window_.first.column, window_.columns);
  const std::int32_t first_row = clamped(std::int64_t{centre.row} - radius, window_.first.row, window_.rows);
  const std::int32_t end_row = clamped(std::int64_t{centre.row} + radius + 1, window_.first.row, window_.rows);
  double best_m2 = std::numeric_limits<double>::infinity();
  std::int32_t best_slot = -1;
  for (std::int32_t row = first_row; row < end_row; ++row) {
    const std::int32_t* const slots = slots_.data() + static_cast<std::ptrdiff_t>(row) * window_.columns;
    for (std::int32_t column = first_column; column < end_column; ++column) {
      const std::int32_t slot = slots[column];
      const double distance_m2 = (mean_m(slot) - point_m).squaredNorm();
      const bool is_nearer = distance_m2 < best_m2;  // without branches, which nothing foretells
      best_m2 = is_nearer ? distance_m2 : best_m2;
      best_slot = is_nearer ? slot : best_slot;
    }
  }
  return best_slot;
}

std::int32_t SurfelMap::find(const Eigen::Vector2d& point_m, int radius) const {
  const std::int32_t slot = nearest_slot(point_m, 1);
  return slot < 0 && radius > 1 ? nearest_slot(point_m, radius) : slot;
}

std::optional<SurfelView> SurfelMap::nearest(const Eigen::Vector2d& point_m, int radius) const {
  const std::int32_t slot = find(point_m, radius);
  if (slot < 0) return std::nullopt;
  return view_of(slot);
}

std::optional<SurfelMap::Surface> SurfelMap::nearest_surface(const Eigen::Vector2d& point_m, int radius) const {
  const std::int32_t slot = find(point_m, radius);
  if (slot < 0) return std::nullopt;
  const auto place = static_cast<std::size_t>(slot);
  const Shape& shape = fresh_shape(place);
  return Surface{mean_m(slot), {shape.normal_x, shape.normal_y}, shape.spread_m2, seen_over_m(moments_[place])};
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
  moved.means_m_.reserve(moments_.size() + 1);
  moved.shares_.reserve(moments_.size());
  moved.shapes_.reserve(moments_.size());
  for (std::size_t place = 0; place < moments_.size(); ++place) {
    if (is_empty(static_cast<std::int32_t>(place)) || !window.contains(cells_[place])) continue;
    CellMoments moments = moments_[place];
    moments.own_echoes = 0.0F;
    const auto slot = static_cast<std::size_t>(moved.make_slot(cells_[place]));
    moved.moments_[slot] = moments;
    moved.means_m_[slot + 1] = means_m_[place + 1];
    moved.shares_[slot] = shares_[place];
  }
  return moved;
}

const CellMoments* SurfelMap::moments_at(Cell cell) const {
  const std::int32_t slot = slot_of(cell);
  return is_empty(slot) ? nullptr : &moments_[static_cast<std::size_t>(slot)];
}

void SurfelMap::set_moments(Cell cell, const CellMoments& moments) {
  if (!window_.contains(cell)) return;
  const auto place = static_cast<std::size_t>(make_slot(cell));
  moments_[place] = moments;
  note_mean(place);
  mark_stale_around(cell);
}

}  // namespace slammot::grids
