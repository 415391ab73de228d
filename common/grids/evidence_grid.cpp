#include "common/grids/evidence_grid.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

#include "common/grids/ray_walk.hpp"

namespace slammot::grids {

int steps_of_log_odds(double log_odds) { return static_cast<int>(std::lround(log_odds / kLogOddsStep)); }

EvidenceGrid::EvidenceGrid(const GridWindow& window, const EvidenceModel& model)
    : window_(window),
      model_(model),
      hit_steps_(steps_of_log_odds(model.hit_log_odds)),
      free_steps_(steps_of_log_odds(model.free_log_odds)),
      limit_steps_(std::min(127, steps_of_log_odds(model.limit_log_odds))),
      block_columns_((window.columns >> kBlockShift) + 1),
      block_rows_((window.rows >> kBlockShift) + 1),
      so_(window.cell_count(), 0),
      mo_(window.cell_count(), 0),
      touched_(window.cell_count(), 0),
      block_has_echoes_(static_cast<std::size_t>(block_columns_) * static_cast<std::size_t>(block_rows_), 0) {}

std::size_t EvidenceGrid::block_index(Cell cell) const {
  return static_cast<std::size_t>((cell.row - window_.first.row) >> kBlockShift) * static_cast<std::size_t>(block_columns_) +
         static_cast<std::size_t>((cell.column - window_.first.column) >> kBlockShift);
}

void EvidenceGrid::begin_scan() {
  if (scan_mark_ == 255) {
    std::fill(touched_.begin(), touched_.end(), std::uint8_t{0});
    scan_mark_ = 0;
  }
  ++scan_mark_;
}

void EvidenceGrid::raise_so(Cell cell, int steps) {
  std::int8_t& so = so_[window_.index(cell)];
  so = static_cast<std::int8_t>(std::min(limit_steps_, so + steps));
  if (so > 0) block_has_echoes_[block_index(cell)] = 1;
}

void EvidenceGrid::mark_echo(const Ray& ray) {
  const Cell cell = window_.cell_at(ray.end_m.x(), ray.end_m.y());
  if (!window_.contains(cell)) return;
  const std::size_t index = window_.index(cell);
  if (touched_[index] == scan_mark_) return;
  touched_[index] = scan_mark_;
  if (ray.echo == Echo::kStationary) {
    raise_so(cell, hit_steps_);
  } else {
    const double missing = 255.0 - mo_[index];
    mo_[index] = static_cast<std::uint8_t>(mo_[index] + static_cast<int>(std::ceil(missing * model_.moving_gain)));
  }
}

void EvidenceGrid::mark_free(const Eigen::Vector2d& origin_m, const Ray& ray) {
  const Eigen::Vector2d way_m = ray.end_m - origin_m;
  const double length_m = way_m.norm();
  // An echo's own cell, and the one that a shallow beam crosses just before it, are not free.
  const double free_m = ray.echo == Echo::kNone ? length_m : length_m - 1.5 * window_.cell_size_m;
  if (free_m <= 0.0) return;
  RayWalk walk(origin_m, way_m / length_m, window_.cell_size_m);
  for (; walk.distance_m() < free_m && window_.contains(walk.cell()); walk.advance()) {
    const std::size_t index = window_.index(walk.cell());
    if (touched_[index] == scan_mark_) continue;
    touched_[index] = scan_mark_;
    so_[index] = static_cast<std::int8_t>(std::max(-limit_steps_, so_[index] - free_steps_));
  }
}

void EvidenceGrid::integrate(const Eigen::Vector2d& origin_m, const std::vector<Ray>& rays) {
  begin_scan();
  for (const Ray& ray : rays) {
    if (ray.echo != Echo::kNone) mark_echo(ray);
  }
  for (const Ray& ray : rays) mark_free(origin_m, ray);
}

void EvidenceGrid::restore_stationary(const Eigen::Vector2d& point_m) {
  const Cell cell = window_.cell_at(point_m.x(), point_m.y());
  if (window_.contains(cell)) raise_so(cell, hit_steps_);
}

int EvidenceGrid::highest_so_steps(Cell cell, int radius) const {
  int highest = std::numeric_limits<std::int8_t>::min();
  for (std::int32_t row = cell.row - radius; row <= cell.row + radius; ++row) {
    for (std::int32_t column = cell.column - radius; column <= cell.column + radius; ++column) {
      highest = std::max(highest, so_steps({column, row}));
    }
  }
  return highest;
}

double EvidenceGrid::distance_to_occupied(const Eigen::Vector2d& origin_m, const Eigen::Vector2d& direction,
                                          double max_range_m, int occupied_steps) const {
  assert(occupied_steps > 0);
  const double size_m = window_.cell_size_m;
  const Eigen::Vector2d lowest_m(window_.first.column * size_m, window_.first.row * size_m);
  RayWalk blocks(origin_m - lowest_m, direction, size_m * (1 << kBlockShift));
  for (; blocks.distance_m() < max_range_m; blocks.advance()) {
    const Cell block = blocks.cell();
    if (block.column < 0 || block.row < 0 || block.column >= block_columns_ || block.row >= block_rows_) break;
    const std::size_t index = static_cast<std::size_t>(block.row) * static_cast<std::size_t>(block_columns_) +
                              static_cast<std::size_t>(block.column);
    if (block_has_echoes_[index] == 0) continue;
    const double entered_m = blocks.distance_m() + 1e-6;  // just inside, whatever the rounding
    RayWalk walk(origin_m + entered_m * direction, direction, size_m);
    const auto in_block = [&](Cell cell) {
      return (cell.column - window_.first.column) >> kBlockShift == block.column &&
             (cell.row - window_.first.row) >> kBlockShift == block.row;
    };
    for (; in_block(walk.cell()); walk.advance()) {
      if (so_steps(walk.cell()) >= occupied_steps) return std::min(max_range_m, entered_m + walk.distance_m());
    }
  }
  return max_range_m;
}

EvidenceGrid EvidenceGrid::moved_to(const GridWindow& window) const {
  assert(window.cell_size_m == window_.cell_size_m);
  EvidenceGrid moved(window, model_);
  const GridWindow shared = intersection(window, window_);
  for (std::int32_t row = 0; row < shared.rows; ++row) {
    for (std::int32_t column = 0; column < shared.columns; ++column) {
      const Cell cell{shared.first.column + column, shared.first.row + row};
      const std::size_t from = window_.index(cell);
      const std::size_t to = window.index(cell);
      moved.so_[to] = so_[from];
      moved.mo_[to] = mo_[from];
      if (so_[from] > 0) moved.block_has_echoes_[moved.block_index(cell)] = 1;
    }
  }
  return moved;
}

void EvidenceGrid::set_cells(std::vector<std::int8_t> so, std::vector<std::uint8_t> mo) {
  assert(so.size() == window_.cell_count() && mo.size() == window_.cell_count());
  so_ = std::move(so);
  mo_ = std::move(mo);
  for (std::int32_t row = 0; row < window_.rows; ++row) {
    for (std::int32_t column = 0; column < window_.columns; ++column) {
      const Cell cell{window_.first.column + column, window_.first.row + row};
      if (so_[window_.index(cell)] > 0) block_has_echoes_[block_index(cell)] = 1;
    }
  }
}

}  // namespace slammot::grids
