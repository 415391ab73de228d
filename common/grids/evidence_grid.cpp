#include "common/grids/evidence_grid.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

#include "common/grids/ray_walk.hpp"

namespace slammot::grids {

namespace {

/// How far a ray that starts inside goes before it leaves the window; 0 when it starts outside.
double distance_to_border(const GridWindow& window, const Eigen::Vector2d& start_m, const Eigen::Vector2d& direction) {
  if (!window.contains(window.cell_at(start_m.x(), start_m.y()))) return 0.0;
  const auto along = [&](double start, double step, std::int32_t first, std::int32_t count) {
    if (step == 0.0) return std::numeric_limits<double>::infinity();
    const double border = (first + (step > 0.0 ? count : 0)) * window.cell_size_m;
    return (border - start) / step;
  };
  // A little short of it: the walk must not step outside by rounding.
  return std::min(along(start_m.x(), direction.x(), window.first.column, window.columns),
                  along(start_m.y(), direction.y(), window.first.row, window.rows)) - 1e-6;
}

}  // namespace

int steps_of_log_odds(double log_odds) { return static_cast<int>(std::lround(log_odds / kLogOddsStep)); }

EvidenceGrid::EvidenceGrid(const GridWindow& window, const EvidenceModel& model)
    : window_(window),
      model_(model),
      hit_steps_(steps_of_log_odds(model.hit_log_odds)),
      free_steps_(steps_of_log_odds(model.free_log_odds)),
      limit_steps_(std::min(127, steps_of_log_odds(model.limit_log_odds))),
      occupied_steps_(std::max(1, steps_of_log_odds(model.occupied_log_odds))),
      block_columns_((window.columns >> kBlockShift) + 1),
      block_rows_((window.rows >> kBlockShift) + 1),
      so_(window.cell_count()),
      mo_(window.cell_count(), 0),
      occupied_bits_(static_cast<std::size_t>(block_columns_) * static_cast<std::size_t>(block_rows_), 0) {}

void EvidenceGrid::note_occupied(std::size_t index) {
  const auto row = static_cast<std::int32_t>(index / static_cast<std::size_t>(window_.columns));
  const auto column = static_cast<std::int32_t>(index % static_cast<std::size_t>(window_.columns));
  std::uint64_t& block = occupied_bits_[static_cast<std::size_t>(row >> kBlockShift) * static_cast<std::size_t>(block_columns_) +
                                        static_cast<std::size_t>(column >> kBlockShift)];
  const std::uint64_t bit = bit_of(column, row);
  block = so_[index].steps >= occupied_steps_ ? block | bit : block & ~bit;
}

void EvidenceGrid::begin_scan() {
  if (scan_mark_ == 255) {
    for (SoCell& cell : so_) cell.touched = 0;
    scan_mark_ = 0;
  }
  ++scan_mark_;
}

void EvidenceGrid::raise_so(Cell cell, int steps) {
  const std::size_t index = window_.index(cell);
  so_[index].steps = static_cast<std::int8_t>(std::min(limit_steps_, so_[index].steps + steps));
  note_occupied(index);
}

void EvidenceGrid::mark_echo(const Ray& ray) {
  const Cell cell = window_.cell_at(ray.end_m.x(), ray.end_m.y());
  if (!window_.contains(cell)) return;
  const std::size_t index = window_.index(cell);
  if (so_[index].touched == scan_mark_) return;
  so_[index].touched = scan_mark_;
  if (ray.echo == Echo::kStationary) {
    raise_so(cell, hit_steps_);
  } else {
    const double missing = 255.0 - mo_[index];
    mo_[index] = static_cast<std::uint8_t>(mo_[index] + static_cast<int>(std::ceil(missing * model_.moving_gain)));
  }
}

void EvidenceGrid::mark_free(const Eigen::Vector2d& origin_m, const Eigen::Vector2d& end_m, double from_m, double to_m) {
  const Eigen::Vector2d direction = (end_m - origin_m).normalized();
  const Eigen::Vector2d start_m = origin_m + from_m * direction;
  const double length_m = std::min(to_m - from_m, distance_to_border(window_, start_m, direction));
  if (length_m <= 0.0) return;
  // Amanatides and Woo 1987, with the array's index in place of the cell: this loop is most of a scan's integration,
  // see tests/bench/common/grids/evidence_grid_bench.cpp.
  RayWalk walk(start_m, direction, window_.cell_size_m);
  auto index = static_cast<std::ptrdiff_t>(window_.index(walk.cell()));
  const RayWalk::Axis columns = walk.columns();
  const RayWalk::Axis rows = walk.rows();
  const std::ptrdiff_t column_stride = columns.step;
  const std::ptrdiff_t row_stride = static_cast<std::ptrdiff_t>(rows.step) * window_.columns;
  double next_column_m = columns.next_border_m;
  double next_row_m = rows.next_border_m;
  double entered_m = 0.0;
  while (entered_m < length_m) {
    SoCell& cell = so_[static_cast<std::size_t>(index)];
    const int before = cell.steps;
    const int lowered = std::max(-limit_steps_, before - free_steps_);
    cell.steps = static_cast<std::int8_t>(cell.touched == scan_mark_ ? before : lowered);
    cell.touched = scan_mark_;
    if (before >= occupied_steps_) note_occupied(static_cast<std::size_t>(index));
    const bool by_column = next_column_m < next_row_m;
    entered_m = by_column ? next_column_m : next_row_m;
    index += by_column ? column_stride : row_stride;
    next_column_m += by_column ? columns.per_cell_m : 0.0;
    next_row_m += by_column ? 0.0 : rows.per_cell_m;
  }
}

void EvidenceGrid::integrate(const Eigen::Vector2d& origin_m, const std::vector<Ray>& rays, double beam_step_rad) {
  begin_scan();
  for (const Ray& ray : rays) {
    if (ray.echo != Echo::kNone) mark_echo(ray);
  }
  if (!window_.contains(window_.cell_at(origin_m.x(), origin_m.y()))) return;
  free_m_.resize(rays.size());
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const double length_m = (rays[i].end_m - origin_m).norm();
    // An echo's own cell, and the one that a shallow beam crosses just before it, are not free.
    free_m_[i] = rays[i].echo == Echo::kNone ? length_m : length_m - 1.5 * window_.cell_size_m;
  }
  for (std::size_t i = 0; i < rays.size(); ++i) {
    if (free_m_[i] <= 0.0) continue;
    mark_free(origin_m, rays[i].end_m, left_to_neighbours_m(i, std::abs(beam_step_rad)), free_m_[i]);
  }
}

double EvidenceGrid::left_to_neighbours_m(std::size_t ray, double beam_step_rad) const {
  if (ray == 0 || beam_step_rad <= 0.0) return 0.0;
  const std::size_t stride = ray & (~ray + 1);  // a neighbour on each side belongs to twice this stride
  if (ray + stride >= free_m_.size()) return 0.0;
  const double crowded_m = 0.7 * window_.cell_size_m / (2.0 * beam_step_rad * static_cast<double>(stride));
  return std::max(0.0, std::min({crowded_m, free_m_[ray - stride], free_m_[ray + stride]}) - window_.cell_size_m);
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
                                          double max_range_m) const {
  const double size_m = window_.cell_size_m;
  const Eigen::Vector2d in_window_m = origin_m - size_m * Eigen::Vector2d(window_.first.column, window_.first.row);
  RayWalk blocks(in_window_m, direction, size_m * (1 << kBlockShift));
  for (; blocks.distance_m() < max_range_m; blocks.advance()) {
    const Cell block = blocks.cell();
    if (block.column < 0 || block.row < 0 || block.column >= block_columns_ || block.row >= block_rows_) break;
    const std::uint64_t bits = occupied_bits_[static_cast<std::size_t>(block.row) * static_cast<std::size_t>(block_columns_) +
                                              static_cast<std::size_t>(block.column)];
    if (bits == 0) continue;
    const double entered_m = blocks.distance_m() + 1e-6;  // just inside, whatever the rounding
    RayWalk walk(in_window_m + entered_m * direction, direction, size_m);
    for (; walk.cell().column >> kBlockShift == block.column && walk.cell().row >> kBlockShift == block.row; walk.advance()) {
      if (bits & bit_of(walk.cell().column, walk.cell().row)) return std::min(max_range_m, entered_m + walk.distance_m());
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
      moved.so_[to].steps = so_[from].steps;
      moved.mo_[to] = mo_[from];
      if (so_[from].steps >= occupied_steps_) moved.note_occupied(to);
    }
  }
  return moved;
}

std::vector<std::int8_t> EvidenceGrid::so_cells() const {
  std::vector<std::int8_t> cells(so_.size());
  std::transform(so_.begin(), so_.end(), cells.begin(), [](const SoCell& cell) { return cell.steps; });
  return cells;
}

void EvidenceGrid::set_cells(std::vector<std::int8_t> so, std::vector<std::uint8_t> mo) {
  assert(so.size() == window_.cell_count() && mo.size() == window_.cell_count());
  mo_ = std::move(mo);
  for (std::size_t i = 0; i < so.size(); ++i) {
    so_[i] = {so[i], 0};
    note_occupied(i);
  }
}

}  // namespace slammot::grids
