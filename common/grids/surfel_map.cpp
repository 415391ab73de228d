#include "common/grids/surfel_map.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstdlib>
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
    : window_(window),
      weight_limit_(static_cast<float>(weight_limit)),
      slots_(window.cell_count(), -1),
      means_m_{kNowhere},
      shares_{Moments::Zero()},
      is_stale_{true} {}

void SurfelMap::clear() {
  for (const Cell& cell : cells_) slots_[window_.index(cell)] = -1;
  moments_.clear();
  cells_.clear();
  shapes_.clear();
  means_m_.resize(1);
  shares_.resize(1, Moments::Zero());
  is_stale_.resize(1);
}

std::int32_t SurfelMap::make_slot(Cell cell) {
  std::int32_t& slot = slots_[window_.index(cell)];
  if (slot < 0) {
    slot = static_cast<std::int32_t>(moments_.size());
    moments_.emplace_back();
    cells_.push_back(cell);
    means_m_.push_back(kNowhere);
    shares_.push_back(Moments::Zero());
    shapes_.emplace_back();
    is_stale_.push_back(true);
  }
  return slot;
}

void SurfelMap::mark_stale_around(Cell cell) {
  const bool is_inside = has_all_around(cell);
  for (std::int32_t row = cell.row - 1; row <= cell.row + 1; ++row) {
    for (std::int32_t column = cell.column - 1; column <= cell.column + 1; ++column) {
      const std::ptrdiff_t slot =
          is_inside ? slots_[window_.index({column, row})] : slot_of({column, row});
      is_stale_[static_cast<std::size_t>(slot + 1)] = true;
    }
  }
}

void SurfelMap::add_to_moments(std::size_t place, const Eigen::Vector2d& point_m,
                               float odometer_m) {
  CellMoments& moments = moments_[place];
  if (moments.weight <= 0.0F) moments.first_seen_at_m = odometer_m;
  moments.last_seen_at_m = odometer_m;
  if (moments.weight >= weight_limit_) {
    const float keep = (weight_limit_ - 1.0F) / moments.weight;
    for (float* sum :
         {&moments.weight, &moments.x, &moments.y, &moments.xx, &moments.xy, &moments.yy})
      *sum *= keep;
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
  std::optional<std::size_t> changed;  // cell with pending moments
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
  // The square root reduces the weight of frequently seen cells: position matters more to a
  // surface's direction than counts do.
  const double share = is_anywhere ? 1.0 / std::sqrt(static_cast<double>(moments.weight)) : 0.0;
  const auto shared = [&](float sum) { return share * static_cast<double>(sum); };
  shares_[place + 1] << shared(moments.weight), shared(moments.x), shared(moments.y),
      shared(moments.xx), shared(moments.xy), shared(moments.yy);
  const Eigen::Vector2d centre_m = window_.centre_of(cells_[place]);
  const auto mean = [&](double centre, float sum) {
    return centre + static_cast<double>(sum) / static_cast<double>(moments.weight);
  };
  means_m_[place + 1] =
      is_anywhere ? Eigen::Vector2d(mean(centre_m.x(), moments.x), mean(centre_m.y(), moments.y))
                  : kNowhere;
}

/// Moments of the cell and its eight neighbours about the cell's centre. The shift of a neighbour's
/// moments is linear in them, so that they are summed by column and row first and shifted together.
SurfelMap::Moments SurfelMap::moments_around(Cell cell) const {
  const bool is_inside = has_all_around(cell);
  const auto share_at = [&](std::int32_t column, std::int32_t row) -> const Moments& {
    const Cell neighbour{cell.column + column, cell.row + row};
    return share_of(is_inside ? slots_[window_.index(neighbour)] : slot_of(neighbour));
  };
  const Moments& left_below = share_at(-1, -1);
  const Moments& right_below = share_at(1, -1);
  const Moments& left_above = share_at(-1, 1);
  const Moments& right_above = share_at(1, 1);
  const Moments left = left_below + share_at(-1, 0) + left_above;
  const Moments right = right_below + share_at(1, 0) + right_above;
  const Moments& straight_below = share_at(0, -1);
  const Moments& straight_above = share_at(0, 1);
  const Moments below = left_below + straight_below + right_below;
  const Moments above = left_above + straight_above + right_above;
  const Moments rightwards = right - left;
  const Moments upwards = above - below;
  const double diagonal = left_below[0] + right_above[0] - left_above[0] - right_below[0];
  const double size_m = window_.cell_size_m;
  Moments around = left + right + straight_below + share_at(0, 0) + straight_above;
  around[1] += size_m * rightwards[0];
  around[2] += size_m * upwards[0];
  around[3] += size_m * (2.0 * rightwards[1] + size_m * (left[0] + right[0]));
  around[4] += size_m * (rightwards[2] + upwards[1] + size_m * diagonal);
  around[5] += size_m * (2.0 * upwards[2] + size_m * (below[0] + above[0]));
  return around;
}

/// Of the echoes in the 3 x 3 cells around.
SurfelMap::Spread SurfelMap::spread_around(Cell cell) const {
  const Moments around = moments_around(cell);
  const double x = around[1] / around[0];
  const double y = around[2] / around[0];
  return {window_.centre_of(cell) + Eigen::Vector2d(x, y), around[3] / around[0] - x * x,
          around[4] / around[0] - x * y, around[5] / around[0] - y * y};
}

std::optional<LoneObject> SurfelMap::lone_object_at(std::size_t place) const {
  const Cell centre = cells_[place];
  for (std::int32_t row = -2; row <= 2; ++row) {
    for (std::int32_t column = -2; column <= 2; ++column) {
      const bool is_around = std::max(std::abs(row), std::abs(column)) == 2;
      if (is_around && !is_empty(slot_of({centre.column + column, centre.row + row})))
        return std::nullopt;
    }
  }
  const Spread spread = spread_around(centre);
  return LoneObject{spread.mean_m, spread.half_trace() + spread.root()};
}

void SurfelMap::renew_shape(std::size_t place) const {
  const double size_m = window_.cell_size_m;
  const Spread spread = spread_around(cells_[place]);
  const double root = spread.root();
  const double large = spread.half_trace() + root;
  const double small = std::max(0.0, spread.half_trace() - root);
  Shape& shape = shapes_[place];
  shape = {0.0F, 0.0F, static_cast<float>(small)};
  is_stale_[place + 1] = false;
  const double least_extent_m = 0.25 * size_m;
  if (large < least_extent_m * least_extent_m || small > 0.25 * large)
    return;  // a point or an isotropic cluster: no direction
  // Sine and cosine of half the angle with tangent 2 cxy / (cxx - cyy): direction of the major
  // axis.
  const double cosine_of_twice = root > 0.0 ? 0.5 * (spread.cxx - spread.cyy) / root : 1.0;
  shape.normal_x = static_cast<float>(
      -std::copysign(std::sqrt(std::max(0.0, 0.5 * (1.0 - cosine_of_twice))), spread.cxy));
  shape.normal_y = static_cast<float>(std::sqrt(std::max(0.0, 0.5 * (1.0 + cosine_of_twice))));
}

const SurfelMap::Shape& SurfelMap::fresh_shape(std::size_t place) const {
  if (is_stale_[place + 1]) renew_shape(place);
  return shapes_[place];
}

SurfelView SurfelMap::view_of(std::int32_t slot) const {
  const auto place = static_cast<std::size_t>(slot);
  const Shape& shape = fresh_shape(place);
  return {cells_[place],
          mean_m(slot),
          {shape.normal_x, shape.normal_y},
          shape.spread_m2,
          moments_[place].weight,
          moments_[place].own_echoes,
          seen_over_m(moments_[place])};
}

std::int32_t SurfelMap::nearest_slot(const Eigen::Vector2d& point_m, int radius) const {
  const Cell centre = window_.cell_at(point_m.x(), point_m.y());
  // 64 bits: points may be anywhere
  const auto clamped = [](std::int64_t place, std::int32_t first, std::int32_t count) {
    return static_cast<std::int32_t>(std::clamp<std::int64_t>(place - first, 0, count));
  };
  const std::int32_t first_column =
      clamped(std::int64_t{centre.column} - radius, window_.first.column, window_.columns);
  const std::int32_t end_column =
      clamped(std::int64_t{centre.column} + radius + 1, window_.first.column, window_.columns);
  const std::int32_t first_row =
      clamped(std::int64_t{centre.row} - radius, window_.first.row, window_.rows);
  const std::int32_t end_row =
      clamped(std::int64_t{centre.row} + radius + 1, window_.first.row, window_.rows);
  double best_m2 = std::numeric_limits<double>::infinity();
  std::int32_t best_slot = -1;
  for (std::int32_t row = first_row; row < end_row; ++row) {
    const std::int32_t* const slots =
        slots_.data() + static_cast<std::ptrdiff_t>(row) * window_.columns;
    for (std::int32_t column = first_column; column < end_column; ++column) {
      const std::int32_t slot = slots[column];
      const double distance_m2 = (mean_m(slot) - point_m).squaredNorm();
      const bool is_nearer = distance_m2 < best_m2;  // branch-free, since branches are
                                                     // unpredictable here
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

std::size_t SurfelMap::nearest_place(const Eigen::Vector2d& point_m, int radius) const {
  const std::int32_t slot = find(point_m, radius);
  return slot < 0 ? kNoPlace : static_cast<std::size_t>(slot);
}

SurfelMap::Surface SurfelMap::surface_at(std::size_t place) const {
  const Shape& shape = fresh_shape(place);
  return {mean_m(static_cast<std::int32_t>(place)),
          {shape.normal_x, shape.normal_y},
          shape.spread_m2,
          seen_over_m(moments_[place])};
}

std::optional<SurfelMap::Surface> SurfelMap::nearest_surface(const Eigen::Vector2d& point_m,
                                                             int radius) const {
  const std::size_t place = nearest_place(point_m, radius);
  return place == kNoPlace ? std::nullopt : std::optional(surface_at(place));
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

std::vector<SurfelMoments> SurfelMap::all_moments(std::vector<SurfelMoments> memory) const {
  memory.clear();
  for (std::size_t place = 0; place < moments_.size(); ++place) {
    if (!is_empty(static_cast<std::int32_t>(place)))
      memory.push_back({cells_[place], moments_[place]});
  }
  return memory;
}

SurfelMap SurfelMap::moved_to(const GridWindow& window) const {
  assert(window.cell_size_m == window_.cell_size_m);
  SurfelMap moved(window, weight_limit_);
  moved.moments_.reserve(moments_.size());
  moved.cells_.reserve(moments_.size());
  moved.means_m_.reserve(moments_.size() + 1);
  moved.shares_.reserve(moments_.size() + 1);
  moved.shapes_.reserve(moments_.size());
  moved.is_stale_.reserve(moments_.size() + 1);
  for (std::size_t place = 0; place < moments_.size(); ++place) {
    if (is_empty(static_cast<std::int32_t>(place)) || !window.contains(cells_[place])) continue;
    CellMoments moments = moments_[place];
    moments.own_echoes = 0.0F;
    const auto slot = static_cast<std::size_t>(moved.make_slot(cells_[place]));
    moved.moments_[slot] = moments;
    moved.means_m_[slot + 1] = means_m_[place + 1];
    moved.shares_[slot + 1] = shares_[place + 1];
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
