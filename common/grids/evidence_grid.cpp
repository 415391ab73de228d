#include "common/grids/evidence_grid.hpp"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <utility>

#include "common/grids/ray_walk.hpp"

namespace slammot::grids {

namespace {

constexpr double kCellsBeforeEcho = 1.5;
constexpr double kCellsBetweenBeams = 3.0;  ///< What is wider than a quarter of that is hit often enough to stay in the map.
constexpr double kMostSlope = 10.0;         ///< Echoes whose ranges differ by more times their distance are of two things.
constexpr std::uint64_t kInRow = 0xff;      ///< Bits of a block's first row.

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
      occupied_bits_(static_cast<std::size_t>(block_columns_) * static_cast<std::size_t>(block_rows_), 0),
      free_(window.columns, window.rows),
      echoed_(window.columns, window.rows) {}

EvidenceGrid::BitRows::BitRows(std::int32_t columns, std::int32_t rows)
    : words_per_row(columns / 64 + 1),
      words(static_cast<std::size_t>(words_per_row) * static_cast<std::size_t>(rows), 0),
      first_word(static_cast<std::size_t>(rows), words_per_row),
      last_word(static_cast<std::size_t>(rows), -1) {}

void EvidenceGrid::BitRows::use(std::int32_t row, std::int32_t word) {
  const auto at = static_cast<std::size_t>(row);
  first_word[at] = std::min(first_word[at], word);
  last_word[at] = std::max(last_word[at], word);
}

void EvidenceGrid::BitRows::flip(std::int32_t column, std::int32_t row) {
  use(row, column >> 6);
  this->row(row)[column >> 6] ^= std::uint64_t{1} << (column & 63);
}

void EvidenceGrid::BitRows::set(std::int32_t column, std::int32_t row) {
  use(row, column >> 6);
  this->row(row)[column >> 6] |= std::uint64_t{1} << (column & 63);
}

void EvidenceGrid::BitRows::clear(std::int32_t column, std::int32_t row) {
  this->row(row)[column >> 6] &= ~(std::uint64_t{1} << (column & 63));
}

bool EvidenceGrid::BitRows::is_set(std::int32_t column, std::int32_t row) const {
  return words[static_cast<std::size_t>(row) * static_cast<std::size_t>(words_per_row) + static_cast<std::size_t>(column >> 6)] >> (column & 63) & 1;
}

void EvidenceGrid::note_occupied(std::size_t index) {
  const auto row = static_cast<std::int32_t>(index / static_cast<std::size_t>(window_.columns));
  const auto column = static_cast<std::int32_t>(index % static_cast<std::size_t>(window_.columns));
  std::uint64_t& block = occupied_bits_[static_cast<std::size_t>(row >> kBlockShift) * static_cast<std::size_t>(block_columns_) +
                                        static_cast<std::size_t>(column >> kBlockShift)];
  const std::uint64_t bit = bit_of(column, row);
  block = so_[index] >= occupied_steps_ ? block | bit : block & ~bit;
}

void EvidenceGrid::raise_so(Cell cell, int steps) {
  const std::size_t index = window_.index(cell);
  so_[index] = static_cast<std::int8_t>(std::min(limit_steps_, so_[index] + steps));
  note_occupied(index);
}

void EvidenceGrid::measure_free_ways(const Eigen::Vector2d& origin_m, const std::vector<Ray>& rays, double beam_step_rad) {
  ways_.resize(rays.size());
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const Eigen::Vector2d way_m = rays[i].end_m - origin_m;
    const double length_m = way_m.norm();
    // An echo's own cell, and the one that a shallow beam crosses just before it, are not free.
    const double free_m = rays[i].echo == Echo::kNone ? length_m : length_m - kCellsBeforeEcho * window_.cell_size_m;
    ways_[i] = {length_m > 0.0 ? Eigen::Vector2d(way_m / length_m) : Eigen::Vector2d(1.0, 0.0), std::max(0.0, free_m), 0.0, 0.0, Eigen::Vector2d::Zero()};
  }
  if (beam_step_rad == 0.0) return;
  const double dense_m = kCellsBetweenBeams * window_.cell_size_m / std::abs(beam_step_rad);
  const bool goes_all_round = static_cast<double>(rays.size() + 1) * std::abs(beam_step_rad) > 2.0 * std::numbers::pi;
  for (std::size_t i = 0; i < ways_.size(); ++i) {
    if (i + 1 == ways_.size() && !goes_all_round) break;
    FreeWay& way = ways_[i];
    FreeWay& next = ways_[(i + 1) % ways_.size()];
    if (way.direction.dot(next.direction) <= std::cos(2.0 * beam_step_rad)) continue;
    way.half_way = (way.direction + next.direction).normalized();
    const double shorter_m = std::min(way.length_m, next.length_m);
    const bool are_of_one_surface = std::abs(way.length_m - next.length_m) < kMostSlope * shorter_m * std::abs(beam_step_rad);
    way.to_next_m = std::min(dense_m, are_of_one_surface ? shorter_m : way.length_m);
    next.to_previous_m = std::min(dense_m, are_of_one_surface ? shorter_m : next.length_m);
  }
}

void EvidenceGrid::outline_free_space(const Eigen::Vector2d& origin_m) {
  const Eigen::Vector2d corner(window_.first.column, window_.first.row);
  const auto at = [&](const Eigen::Vector2d& direction, double distance_m) -> Eigen::Vector2d {
    return (origin_m + distance_m * direction) / window_.cell_size_m - corner;
  };
  for (std::size_t i = 0; i < ways_.size(); ++i) {
    const FreeWay& way = ways_[i];
    const FreeWay& next = ways_[i + 1 == ways_.size() ? 0 : i + 1];
    if (way.to_previous_m != way.to_next_m) add_edge(at(way.direction, way.to_previous_m), at(way.direction, way.to_next_m));
    if (way.half_way.isZero()) continue;
    if (way.to_next_m > 0.0) add_edge(at(way.direction, way.to_next_m), at(way.half_way, way.to_next_m));
    if (way.to_next_m != next.to_previous_m) add_edge(at(way.half_way, way.to_next_m), at(way.half_way, next.to_previous_m));
    if (next.to_previous_m > 0.0) add_edge(at(way.half_way, next.to_previous_m), at(next.direction, next.to_previous_m));
  }
}

/// Flips, in each row whose middle the edge crosses, the first cell whose centre lies right of it: from there to the next
/// flip the row is inside the outline. In cells of the window.
void EvidenceGrid::add_edge(const Eigen::Vector2d& from, const Eigen::Vector2d& to) {
  const auto [low, high] = from.y() < to.y() ? std::pair(from, to) : std::pair(to, from);
  const auto first_centre = [](double place, std::int32_t count) {
    return static_cast<std::int32_t>(std::clamp(std::ceil(place - 0.5), 0.0, static_cast<double>(count)));
  };
  const std::int32_t first_row = first_centre(low.y(), window_.rows);
  const std::int32_t end_row = first_centre(high.y(), window_.rows);
  if (first_row >= end_row) return;
  const double slope = (high.x() - low.x()) / (high.y() - low.y());
  for (std::int32_t row = first_row; row < end_row; ++row) {
    free_.flip(first_centre(low.x() + slope * (row + 0.5 - low.y()), window_.columns), row);
  }
}

void EvidenceGrid::fill_outline() {
  for (std::int32_t row = 0; row < window_.rows; ++row) {
    const auto at = static_cast<std::size_t>(row);
    std::uint64_t* const words = free_.row(row);
    std::uint64_t carry = 0;
    for (std::int32_t word = free_.first_word[at]; word <= free_.last_word[at]; ++word) {
      std::uint64_t inside = words[word];
      if (inside != 0) {
        for (const int shift : {1, 2, 4, 8, 16, 32}) inside ^= inside << shift;  // parity of the flips up to each bit
      }
      inside ^= carry;
      carry = inside >> 63 ? ~std::uint64_t{0} : 0;
      words[word] = inside;
    }
  }
}

void EvidenceGrid::walk_free_way(const Eigen::Vector2d& origin_m, const Eigen::Vector2d& direction, double from_m, double to_m) {
  const Eigen::Vector2d start_m = origin_m + from_m * direction;
  const double length_m = std::min(to_m - from_m, distance_to_border(window_, start_m, direction));
  if (length_m <= 0.0) return;
  for (RayWalk walk(start_m, direction, window_.cell_size_m); walk.distance_m() < length_m; walk.advance()) {
    free_.set(walk.cell().column - window_.first.column, walk.cell().row - window_.first.row);
  }
}

void EvidenceGrid::keep_echoes_out(const std::vector<Ray>& rays) {
  for (const Ray& ray : rays) {
    const Cell cell = window_.cell_at(ray.end_m.x(), ray.end_m.y());
    if (ray.echo != Echo::kNone && window_.contains(cell)) free_.clear(cell.column - window_.first.column, cell.row - window_.first.row);
  }
}

void EvidenceGrid::lower(std::int32_t row, std::int32_t first_column, std::int32_t count) {
  const auto first = static_cast<std::size_t>(row) * static_cast<std::size_t>(window_.columns) + static_cast<std::size_t>(first_column);
  std::int8_t* const cells = so_.data() + first;
  const auto step = static_cast<std::int8_t>(free_steps_);
  const auto lowest = static_cast<std::int8_t>(free_steps_ - limit_steps_);
  for (std::int32_t i = 0; i < count; ++i) cells[i] = static_cast<std::int8_t>(std::max(cells[i], lowest) - step);
  const std::int32_t last_block = (first_column + count - 1) >> kBlockShift;
  const std::uint64_t of_row = std::uint64_t{kInRow} << ((row & kInBlock) << kBlockShift);
  for (std::int32_t block = first_column >> kBlockShift; block <= last_block; ++block) {
    std::uint64_t& bits = occupied_bits_[static_cast<std::size_t>(row >> kBlockShift) * static_cast<std::size_t>(block_columns_) + static_cast<std::size_t>(block)];
    if ((bits & of_row) == 0) continue;
    const std::int32_t end = std::min(first_column + count, (block + 1) << kBlockShift);
    for (std::int32_t column = std::max(first_column, block << kBlockShift); column < end; ++column) {
      if (cells[column - first_column] < occupied_steps_) bits &= ~bit_of(column, row);
    }
  }
}

void EvidenceGrid::lower_free_cells() {
  for (std::int32_t row = 0; row < window_.rows; ++row) {
    const auto at = static_cast<std::size_t>(row);
    std::uint64_t* const words = free_.row(row);
    std::int32_t run_begin = 0;  // of a run that goes on from word to word
    bool is_in_run = false;
    const auto end_run = [&](std::int32_t column) {
      if (is_in_run) lower(row, run_begin, std::min(column, window_.columns) - run_begin);
      is_in_run = false;
    };
    for (std::int32_t word = free_.first_word[at]; word <= free_.last_word[at]; ++word) {
      const std::uint64_t bits = std::exchange(words[word], 0);
      for (int bit = 0; bit < 64;) {
        if (is_in_run) {
          bit += std::countr_one(bits >> bit);
          if (bit < 64) end_run(word * 64 + bit);
        } else {
          if (bits >> bit == 0) break;
          bit += std::countr_zero(bits >> bit);
          run_begin = word * 64 + bit;
          is_in_run = true;
        }
      }
    }
    end_run((free_.last_word[at] + 1) * 64);
    free_.first_word[at] = free_.words_per_row;
    free_.last_word[at] = -1;
  }
}

void EvidenceGrid::raise_echoes(const std::vector<Ray>& rays) {
  const auto in_window = [&](const Ray& ray) -> std::optional<Cell> {
    const Cell cell = window_.cell_at(ray.end_m.x(), ray.end_m.y());
    if (ray.echo == Echo::kNone || !window_.contains(cell)) return std::nullopt;
    return cell;
  };
  for (const Ray& ray : rays) {
    const auto cell = in_window(ray);
    if (!cell || echoed_.is_set(cell->column - window_.first.column, cell->row - window_.first.row)) continue;
    echoed_.set(cell->column - window_.first.column, cell->row - window_.first.row);
    if (ray.echo == Echo::kStationary) {
      raise_so(*cell, hit_steps_);
    } else {
      std::uint8_t& moved = mo_[window_.index(*cell)];
      moved = static_cast<std::uint8_t>(moved + static_cast<int>(std::ceil((255.0 - moved) * model_.moving_gain)));
    }
  }
  for (const Ray& ray : rays) {
    if (const auto cell = in_window(ray)) echoed_.clear(cell->column - window_.first.column, cell->row - window_.first.row);
  }
}

void EvidenceGrid::integrate(const Eigen::Vector2d& origin_m, const std::vector<Ray>& rays, double beam_step_rad) {
  if (window_.contains(window_.cell_at(origin_m.x(), origin_m.y()))) {
    measure_free_ways(origin_m, rays, beam_step_rad);
    outline_free_space(origin_m);
    fill_outline();
    for (std::size_t i = 0; i < ways_.size(); ++i) {
      walk_free_way(origin_m, ways_[i].direction, std::max(ways_[i].to_next_m, ways_[i].to_previous_m), ways_[i].length_m);
    }
    keep_echoes_out(rays);
    lower_free_cells();
  }
  raise_echoes(rays);
}

void EvidenceGrid::restore_stationary(const Eigen::Vector2d& point_m) {
  const Cell cell = window_.cell_at(point_m.x(), point_m.y());
  if (window_.contains(cell)) raise_so(cell, hit_steps_);
}

int EvidenceGrid::highest_so_steps(Cell cell, int radius) const {
  const GridWindow square{window_.cell_size_m, {cell.column - radius, cell.row - radius}, 2 * radius + 1, 2 * radius + 1};
  const GridWindow inside = window_.contains(cell) ? intersection(window_, square) : GridWindow{};
  int highest = inside.cell_count() < square.cell_count() ? 0 : std::numeric_limits<std::int8_t>::min();  // never seen outside
  for (std::int32_t row = 0; row < inside.rows; ++row) {
    const std::int8_t* const cells = so_.data() + window_.index({inside.first.column, inside.first.row + row});
    for (std::int32_t column = 0; column < inside.columns; ++column) highest = std::max<int>(highest, cells[column]);
  }
  return highest;
}

/// Walks over the blocks that the ray meets, and over the cells of those in which something is occupied; Amanatides and
/// Woo 1987, all in cells of the window. Most of a scan's polar map view: see cast_a_scan of the benchmark.
double EvidenceGrid::distance_to_occupied(const Eigen::Vector2d& origin_m, const Eigen::Vector2d& direction,
                                          double max_range_m) const {
  constexpr double kNever = std::numeric_limits<double>::infinity();
  constexpr double kBlock = 1 << kBlockShift;
  const double size_m = window_.cell_size_m;
  const double max_range = max_range_m / size_m;
  const double x = origin_m.x() / size_m - window_.first.column;
  const double y = origin_m.y() / size_m - window_.first.row;
  const std::int32_t column_step = direction.x() > 0.0 ? 1 : -1;
  const std::int32_t row_step = direction.y() > 0.0 ? 1 : -1;
  const double per_column = direction.x() != 0.0 ? 1.0 / direction.x() : kNever;   // signed: way for one cell to the right
  const double per_row = direction.y() != 0.0 ? 1.0 / direction.y() : kNever;
  const auto border_at = [](double border, double start, double per_cell) { return std::isinf(per_cell) ? kNever : (border - start) * per_cell; };
  auto block_column = static_cast<std::int32_t>(std::floor(x / kBlock));
  auto block_row = static_cast<std::int32_t>(std::floor(y / kBlock));
  double next_column = border_at(kBlock * (block_column + (column_step > 0)), x, per_column);
  double next_row = border_at(kBlock * (block_row + (row_step > 0)), y, per_row);
  double entered = 0.0;
  while (entered < max_range && block_column >= 0 && block_row >= 0 && block_column < block_columns_ && block_row < block_rows_) {
    const std::uint64_t bits = occupied_bits_[static_cast<std::size_t>(block_row) * static_cast<std::size_t>(block_columns_) +
                                              static_cast<std::size_t>(block_column)];
    if (bits != 0) {
      // In cells of the block. Clamped: rounding must not put the entry beside it.
      const double x_in_block = x - kBlock * block_column;
      const double y_in_block = y - kBlock * block_row;
      auto column = static_cast<std::int32_t>(std::clamp(std::floor(x_in_block + entered * direction.x()), 0.0, kBlock - 1.0));
      auto row = static_cast<std::int32_t>(std::clamp(std::floor(y_in_block + entered * direction.y()), 0.0, kBlock - 1.0));
      double next_cell_column = border_at(column + (column_step > 0), x_in_block, per_column);
      double next_cell_row = border_at(row + (row_step > 0), y_in_block, per_row);
      for (double at = entered; ((column | row) & ~kInBlock) == 0;) {
        if (bits >> ((row << kBlockShift) | column) & 1) return std::min(max_range_m, at * size_m);
        const bool by_column = next_cell_column < next_cell_row;
        at = by_column ? next_cell_column : next_cell_row;
        column += by_column ? column_step : 0;
        row += by_column ? 0 : row_step;
        next_cell_column += by_column ? std::abs(per_column) : 0.0;
        next_cell_row += by_column ? 0.0 : std::abs(per_row);
      }
    }
    const bool by_column = next_column < next_row;
    entered = by_column ? next_column : next_row;
    block_column += by_column ? column_step : 0;
    block_row += by_column ? 0 : row_step;
    next_column += by_column ? kBlock * std::abs(per_column) : 0.0;
    next_row += by_column ? 0.0 : kBlock * std::abs(per_row);
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
      if (so_[from] >= occupied_steps_) moved.note_occupied(to);
    }
  }
  return moved;
}

void EvidenceGrid::set_cells(std::vector<std::int8_t> so, std::vector<std::uint8_t> mo) {
  assert(so.size() == window_.cell_count() && mo.size() == window_.cell_count());
  so_ = std::move(so);
  mo_ = std::move(mo);
  for (std::size_t i = 0; i < so_.size(); ++i) note_occupied(i);
}

}  // namespace slammot::grids
