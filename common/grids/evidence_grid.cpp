#include "common/grids/evidence_grid.hpp"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>
#include <limits>
#include <utility>

#include "common/geometry/full_turn.hpp"
#include "common/grids/lowered_cells.hpp"
#include "common/grids/ray_walk.hpp"

namespace slammot::grids {

namespace {

constexpr double kCellsBeforeEcho = 1.5;
constexpr double kCellsBetweenBeams = 3.0;  ///< Objects wider than a quarter of it are hit often
                                            ///< enough to stay in the map.
constexpr double kMostSlope = 10.0;  ///< A larger ratio of range difference to distance separates
                                     ///< two surfaces.
constexpr std::uint64_t kInRow = 0xff;  ///< Bits of a block's first row.

bool is_mapped(Echo echo) { return echo == Echo::kStationary || echo == Echo::kMoving; }

using TwoPlaces [[gnu::vector_size(16)]] = double;
using TwoCells [[gnu::vector_size(8)]] = std::int32_t;

/// For each of two coordinates, the first cell whose centre is at or beyond it.
TwoCells first_centres(TwoPlaces places, std::int32_t count) {
  const TwoPlaces end = TwoPlaces{} + static_cast<double>(count);
  const TwoPlaces from_first = places - 0.5;
  const TwoPlaces inside = from_first > 0.0 ? from_first : TwoPlaces{};
  const TwoPlaces at = inside < end ? inside : end;
  const TwoCells below = __builtin_convertvector(at, TwoCells);
  // rounded up: true is -1
  return below - __builtin_convertvector(__builtin_convertvector(below, TwoPlaces) < at, TwoCells);
}

/// Coordinates in cells of the window.
Eigen::Vector2d in_cells(const Eigen::Vector2d& at_m, const GridWindow& window) {
  return at_m / window.cell_size_m - Eigen::Vector2d(window.first.column, window.first.row);
}

/// Flips, in each row whose centre the edge crosses, the first cell whose centre is right of the
/// edge. Between two flips a row is inside the outline. Coordinates in cells of the window.
void add_edge(const Eigen::Vector2d& from, const Eigen::Vector2d& to, const GridWindow& window,
              BitRows& outline) {
  const auto [low, high] = from.y() < to.y() ? std::pair(from, to) : std::pair(to, from);
  const TwoCells rows = first_centres(TwoPlaces{low.y(), high.y()}, window.rows);
  const std::int32_t first_row = rows[0];
  const std::int32_t end_row = rows[1];
  if (first_row >= end_row) return;
  const double slope = (high.x() - low.x()) / (high.y() - low.y());
  const std::int32_t column_count = window.columns;  // a local copy: the compiler cannot know that
                                                     // flips leave it unchanged
  TwoPlaces middles{first_row + 0.5, first_row + 1.5};
  for (std::int32_t row = first_row; row < end_row; row += 2, middles += 2.0) {
    const TwoCells columns = first_centres(low.x() + slope * (middles - low.y()), column_count);
    outline.flip(columns[0], row);
    if (row + 1 < end_row) outline.flip(columns[1], row + 1);
  }
}

void fill(BitRows& outline) {
  for (std::size_t row = 0; row < outline.first_word.size(); ++row) {
    std::uint64_t* const words = outline.row(static_cast<std::int32_t>(row));
    std::uint64_t carry = 0;
    for (std::int32_t word = outline.first_word[row]; word <= outline.last_word[row]; ++word) {
      std::uint64_t inside = words[word];
      if (inside != 0) {
        for (const int shift : {1, 2, 4, 8, 16, 32})
          inside ^= inside << shift;  // prefix parity of the flips
      }
      inside ^= carry;
      carry = inside >> 63 ? ~std::uint64_t{0} : 0;
      words[word] = inside;
    }
  }
}

/// Length of a ray from inside the window to its border; 0 if it starts outside.
double distance_to_border(const GridWindow& window, const Eigen::Vector2d& start_m,
                          const Eigen::Vector2d& direction) {
  if (!window.contains(window.cell_at(start_m.x(), start_m.y()))) return 0.0;
  const auto along = [&](double start, double step, std::int32_t first, std::int32_t count) {
    if (step == 0.0) return std::numeric_limits<double>::infinity();
    const double border = (first + (step > 0.0 ? count : 0)) * window.cell_size_m;
    return (border - start) / step;
  };
  // Slightly shorter, so that rounding cannot move the walk out of the window.
  return std::min(along(start_m.x(), direction.x(), window.first.column, window.columns),
                  along(start_m.y(), direction.y(), window.first.row, window.rows)) -
         1e-6;
}

}  // namespace

/// A ray in cells of the window, one coordinate.
struct EvidenceGrid::RayInCells {
  struct Axis {
    double start;
    double direction;
    double per_cell;    ///< Signed: distance along the ray per cell; infinite if parallel to the
                        ///< border.
    std::int32_t step;  ///< Sign of the ray's direction, in cells.

    Axis(double start_at, double towards)
        : start(start_at),
          direction(towards),
          per_cell(towards != 0.0 ? 1.0 / towards : std::numeric_limits<double>::infinity()),
          step(towards > 0.0 ? 1 : -1) {}

    /// Distance along the ray to the border; infinite if the ray never crosses it.
    double way_to(std::int32_t border) const {
      return direction != 0.0 ? (border - start) * per_cell
                              : std::numeric_limits<double>::infinity();
    }
  };

  RayInCells(const Eigen::Vector2d& start, const Eigen::Vector2d& direction)
      : x(start.x(), direction.x()), y(start.y(), direction.y()) {}
  /// The same ray with another origin of the cells.
  RayInCells(const Eigen::Vector2d& start, const RayInCells& same) : x(same.x), y(same.y) {
    x.start = start.x();
    y.start = start.y();
  }

  Axis x;
  Axis y;
};

EvidenceGrid::EvidenceGrid(const GridWindow& window, const EvidenceModel& model,
                           const LastingModel& lasting)
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
      lasting_(window, lasting),
      occupied_bits_(
          static_cast<std::size_t>(block_columns_) * static_cast<std::size_t>(block_rows_), 0),
      rows_of_blocks_(block_rows_, block_columns_),
      columns_of_blocks_(block_columns_, block_rows_),
      lowest_(window.columns, window.rows),
      free_(window.columns, window.rows),
      surely_free_(window.columns, window.rows),
      echoed_(window.columns, window.rows) {}

/// Index of the cell at this offset from the window's first cell.
void EvidenceGrid::note_occupied(std::int32_t column, std::int32_t row) {
  const std::size_t index =
      static_cast<std::size_t>(row) * static_cast<std::size_t>(window_.columns) +
      static_cast<std::size_t>(column);
  std::uint64_t& block = occupied_bits_[static_cast<std::size_t>(row >> kBlockShift) *
                                            static_cast<std::size_t>(block_columns_) +
                                        static_cast<std::size_t>(column >> kBlockShift)];
  const std::uint64_t bit = bit_of(column, row);
  const bool was_empty = block == 0;
  block = so_[index] >= occupied_steps_ ? block | bit : block & ~bit;
  if (was_empty != (block == 0)) note_block(column >> kBlockShift, row >> kBlockShift, block != 0);
}

void EvidenceGrid::note_block(std::int32_t block_column, std::int32_t block_row, bool is_occupied) {
  rows_of_blocks_.set(block_row, block_column, is_occupied);
  columns_of_blocks_.set(block_column, block_row, is_occupied);
}

void EvidenceGrid::raise_so(Cell cell, int steps) {
  const std::int32_t column = cell.column - window_.first.column;
  const std::int32_t row = cell.row - window_.first.row;
  std::int8_t& so_steps = so_[window_.index(cell)];
  so_steps = static_cast<std::int8_t>(std::min(limit_steps_, so_steps + steps));
  lowest_.clear(column, row);
  note_occupied(column, row);
}

void EvidenceGrid::measure_free_ways(const Eigen::Vector2d& origin_m, const std::vector<Ray>& rays,
                                     double beam_step_rad) {
  ways_.resize(rays.size());
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const Eigen::Vector2d way_m = rays[i].end_m - origin_m;
    const double length_m = way_m.norm();
    // The echo's own cell is not free, nor is the cell that a beam at grazing incidence crosses
    // just before it.
    const double free_m =
        rays[i].echo == Echo::kNone ? length_m : length_m - kCellsBeforeEcho * window_.cell_size_m;
    ways_[i] = {length_m > 0.0 ? Eigen::Vector2d(way_m / length_m) : Eigen::Vector2d(1.0, 0.0),
                std::max(0.0, free_m),
                0.0,
                0.0,
                0.0,
                Eigen::Vector2d::Zero()};
  }
  if (beam_step_rad == 0.0) return;
  const double dense_m = kCellsBetweenBeams * window_.cell_size_m / std::abs(beam_step_rad);
  const bool goes_all_round = geometry::goes_all_round(rays.size(), beam_step_rad);
  const double cosine_of_two_steps = std::cos(2.0 * beam_step_rad);
  for (std::size_t i = 0; i < ways_.size(); ++i) {
    if (i + 1 == ways_.size() && !goes_all_round) break;
    FreeWay& way = ways_[i];
    FreeWay& next = ways_[(i + 1) % ways_.size()];
    if (way.direction.dot(next.direction) <= cosine_of_two_steps) continue;
    way.half_way = (way.direction + next.direction).normalized();
    const double shorter_m = std::min(way.length_m, next.length_m);
    const bool are_of_one_surface =
        std::abs(way.length_m - next.length_m) < kMostSlope * shorter_m * std::abs(beam_step_rad);
    way.to_next_m = std::min(dense_m, are_of_one_surface ? shorter_m : way.length_m);
    next.to_previous_m = std::min(dense_m, are_of_one_surface ? shorter_m : next.length_m);
  }
  measure_surely_free_ways(rays);
}

void EvidenceGrid::measure_surely_free_ways(const std::vector<Ray>& rays) {
  const auto end_m = [&](std::size_t i) {
    return rays[i].echo == Echo::kNone ? std::numeric_limits<double>::infinity()
                                       : ways_[i].length_m;
  };
  for (std::size_t i = 0; i < ways_.size(); ++i) {
    const std::size_t next = i + 1 == ways_.size() ? 0 : i + 1;
    const std::size_t previous = i == 0 ? ways_.size() - 1 : i - 1;
    const bool is_between = !ways_[i].half_way.isZero() && !ways_[previous].half_way.isZero();
    ways_[i].surely_m =
        is_between ? std::min({end_m(previous), ways_[i].length_m, end_m(next)}) : 0.0;
  }
}

void EvidenceGrid::outline_free_space(const Eigen::Vector2d& origin_m, std::size_t first_way,
                                      std::size_t end_way) {
  const auto at = [&](const Eigen::Vector2d& direction, double distance_m) {
    return in_cells(origin_m + distance_m * direction, window_);
  };
  const auto add_edge = [&](const Eigen::Vector2d& from, const Eigen::Vector2d& to) {
    grids::add_edge(from, to, window_, free_);
  };
  for (std::size_t i = first_way; i < end_way; ++i) {
    const FreeWay& way = ways_[i];
    const FreeWay& next = ways_[i + 1 == ways_.size() ? 0 : i + 1];
    if (way.to_previous_m != way.to_next_m)
      add_edge(at(way.direction, way.to_previous_m), at(way.direction, way.to_next_m));
    if (way.half_way.isZero()) continue;
    if (way.to_next_m > 0.0)
      add_edge(at(way.direction, way.to_next_m), at(way.half_way, way.to_next_m));
    if (way.to_next_m != next.to_previous_m)
      add_edge(at(way.half_way, way.to_next_m), at(way.half_way, next.to_previous_m));
    if (next.to_previous_m > 0.0)
      add_edge(at(way.half_way, next.to_previous_m), at(next.direction, next.to_previous_m));
  }
}

/// Outlines the sectors half way to the neighbouring beams, as far as the echoes of the neighbours
/// allow, whatever the spacing of the beams.
void EvidenceGrid::outline_surely_free(const Eigen::Vector2d& origin_m, std::size_t first_way,
                                       std::size_t end_way) {
  const auto at = [&](const Eigen::Vector2d& direction, double distance_m) {
    return in_cells(origin_m + distance_m * direction, window_);
  };
  if (first_way == end_way) return;
  const FreeWay& before = ways_[first_way == 0 ? ways_.size() - 1 : first_way - 1];
  Eigen::Vector2d begins = at(before.half_way, ways_[first_way].surely_m);
  for (std::size_t i = first_way; i < end_way; ++i) {
    const FreeWay& way = ways_[i];
    const FreeWay& next = ways_[i + 1 == ways_.size() ? 0 : i + 1];
    const Eigen::Vector2d ends = at(way.half_way, way.surely_m);
    const Eigen::Vector2d next_begins = at(way.half_way, next.surely_m);
    if (way.surely_m > 0.0) add_edge(begins, ends, window_, surely_free_);
    if (way.surely_m != next.surely_m) add_edge(ends, next_begins, window_, surely_free_);
    begins = next_begins;
  }
}

void EvidenceGrid::walk_free_way(const Eigen::Vector2d& origin_m, const Eigen::Vector2d& direction,
                                 double from_m, double to_m) {
  if (to_m <= from_m) return;  // nearly always
  const Eigen::Vector2d start_m = origin_m + from_m * direction;
  const double length_m = std::min(to_m - from_m, distance_to_border(window_, start_m, direction));
  if (length_m <= 0.0) return;
  for (RayWalk walk(start_m, direction, window_.cell_size_m); walk.distance_m() < length_m;
       walk.advance()) {
    free_.set(walk.cell().column - window_.first.column, walk.cell().row - window_.first.row);
  }
}

/// Marks the cells of echoes inside the window.
void EvidenceGrid::find_echoes(const std::vector<Ray>& rays) {
  echoes_.clear();
  for (std::size_t i = 0; i < rays.size(); ++i) {
    if (!is_mapped(rays[i].echo)) continue;
    const Cell cell = window_.cell_at(rays[i].end_m.x(), rays[i].end_m.y());
    if (window_.contains(cell))
      echoes_.push_back({cell.column - window_.first.column, cell.row - window_.first.row, i});
  }
}

void EvidenceGrid::keep_echoes_out() {
  for (const EchoedCell& echo : echoes_) {
    free_.clear(echo.column, echo.row);
    surely_free_.clear(echo.column, echo.row);
  }
}

void EvidenceGrid::lower(std::int32_t row, std::int32_t word, std::uint64_t free_cells) {
  std::uint64_t& lowest = lowest_.row(row)[word];
  const std::uint64_t to_lower = free_cells & ~lowest;
  if (to_lower == 0) return;
  const std::int32_t first_column = word * kCellsPerWord;
  const std::int32_t count = std::min(kCellsPerWord, window_.columns - first_column);
  std::int8_t* const cells =
      so_.data() + static_cast<std::size_t>(row) * static_cast<std::size_t>(window_.columns) +
      static_cast<std::size_t>(first_column);
  lowest |= lower_cells(cells, count, to_lower, free_steps_, -limit_steps_);
  unnote_freed(row, word, to_lower);
}

/// Clears the occupied bits of the word's cells that are no longer occupied.
void EvidenceGrid::unnote_freed(std::int32_t row, std::int32_t word, std::uint64_t free_cells) {
  const std::int32_t block_row = row >> kBlockShift;
  const int row_shift = (row & kInBlock) << kBlockShift;
  const std::int8_t* const cells =
      so_.data() + static_cast<std::size_t>(row) * static_cast<std::size_t>(window_.columns);
  for (std::uint64_t blocks = rows_of_blocks_.eight(block_row, word); blocks != 0;
       blocks &= blocks - 1) {
    const std::uint64_t free_in_block =
        free_cells >> (std::countr_zero(blocks) << kBlockShift) & kInRow;
    if (free_in_block == 0) continue;
    const std::int32_t block = (word << kBlockShift) + std::countr_zero(blocks);
    std::uint64_t& bits = occupied_bits_[static_cast<std::size_t>(block_row) *
                                             static_cast<std::size_t>(block_columns_) +
                                         static_cast<std::size_t>(block)];
    for (std::uint64_t occupied = bits >> row_shift & free_in_block; occupied != 0;
         occupied &= occupied - 1) {
      const std::int32_t column = (block << kBlockShift) + std::countr_zero(occupied);
      if (cells[column] < occupied_steps_) bits &= ~bit_of(column, row);
    }
    if (bits == 0) note_block(block, block_row, false);
  }
}

void EvidenceGrid::lower_free_cells() {
  free_.take_all([&](std::int32_t row, std::int32_t word, std::uint64_t free_cells) {
    lower(row, word, free_cells);
  });
}

void EvidenceGrid::clear_free_cells() {
  free_.clear_all();
  surely_free_.clear_all();
}

void EvidenceGrid::raise_echoes(const std::vector<Ray>& rays) {
  for (const EchoedCell& echo : echoes_) {
    if (echoed_.is_set(echo.column, echo.row)) continue;
    echoed_.set(echo.column, echo.row);
    const Cell cell{window_.first.column + echo.column, window_.first.row + echo.row};
    if (rays[echo.ray].echo == Echo::kStationary) {
      raise_so(cell, hit_steps_);
      lasting_.hit(cell);
    } else {
      std::uint8_t& moved = mo_[window_.index(cell)];
      moved = static_cast<std::uint8_t>(
          moved + static_cast<int>(std::ceil((255.0 - moved) * model_.moving_gain)));
    }
  }
  for (const EchoedCell& echo : echoes_) echoed_.clear(echo.column, echo.row);
}

void EvidenceGrid::begin_finding_free_cells(const Eigen::Vector2d& origin_m,
                                            const std::vector<Ray>& rays, double beam_step_rad) {
  find_echoes(rays);
  outlined_ways_ = 0;
  ways_.clear();
  if (window_.contains(window_.cell_at(origin_m.x(), origin_m.y())))
    measure_free_ways(origin_m, rays, beam_step_rad);
}

/// Returns false once all are found.
bool EvidenceGrid::find_more_free_cells(const Eigen::Vector2d& origin_m) {
  constexpr std::size_t kWaysAtOnce = 48;
  const std::size_t end_way = std::min(outlined_ways_ + kWaysAtOnce, ways_.size());
  outline_free_space(origin_m, outlined_ways_, end_way);
  outline_surely_free(origin_m, outlined_ways_, end_way);
  outlined_ways_ = end_way;
  if (outlined_ways_ < ways_.size()) return true;
  fill(free_);
  fill(surely_free_);
  for (const FreeWay& way : ways_)
    walk_free_way(origin_m, way.direction, std::max(way.to_next_m, way.to_previous_m),
                  way.length_m);
  keep_echoes_out();
  return false;
}

bool EvidenceGrid::is_prepared_for(const Eigen::Vector2d& origin_m, const std::vector<Ray>& rays,
                                   double beam_step_rad) const {
  const auto tell_of_the_same_cells = [](const Ray& a, const Ray& b) {
    return a.end_m == b.end_m && (a.echo == b.echo || (is_mapped(a.echo) && is_mapped(b.echo)));
  };
  return is_prepared_ && origin_m == prepared_origin_m_ && beam_step_rad == prepared_step_rad_ &&
         std::ranges::equal(rays, prepared_rays_, tell_of_the_same_cells);
}

void EvidenceGrid::prepare(const Eigen::Vector2d& origin_m, const std::vector<Ray>& rays,
                           double beam_step_rad) {
  begin_preparing(origin_m, rays, beam_step_rad);
  while (go_on_preparing()) {}
}

void EvidenceGrid::begin_preparing(const Eigen::Vector2d& origin_m, const std::vector<Ray>& rays,
                                   double beam_step_rad) {
  if (is_prepared_ || is_being_prepared_) clear_free_cells();
  prepared_origin_m_ = origin_m;
  prepared_step_rad_ = beam_step_rad;
  prepared_rays_ = rays;
  begin_finding_free_cells(origin_m, rays, beam_step_rad);
  is_prepared_ = false;
  is_being_prepared_ = true;
}

bool EvidenceGrid::go_on_preparing() {
  if (!is_being_prepared_) return false;
  is_being_prepared_ = find_more_free_cells(prepared_origin_m_);
  is_prepared_ = !is_being_prepared_;
  return is_being_prepared_;
}

void EvidenceGrid::integrate(const Eigen::Vector2d& origin_m, const std::vector<Ray>& rays,
                             double beam_step_rad) {
  if (!is_prepared_for(origin_m, rays, beam_step_rad)) {
    if (is_prepared_ || is_being_prepared_) clear_free_cells();
    begin_finding_free_cells(origin_m, rays, beam_step_rad);
    while (find_more_free_cells(origin_m)) {}
  }
  is_prepared_ = is_being_prepared_ = false;
  lasting_.pass(surely_free_);
  lower_free_cells();
  raise_echoes(rays);
}

void EvidenceGrid::restore_stationary(const Eigen::Vector2d& point_m, Echo integrated_as) {
  const Cell cell = window_.cell_at(point_m.x(), point_m.y());
  if (!window_.contains(cell)) return;
  raise_so(cell, hit_steps_);
  if (integrated_as != Echo::kStationary) lasting_.hit(cell);
}

void EvidenceGrid::drive_over(const Box& body) {
  const CellRange cells = cells_around(body, window_);
  if (cells.is_empty()) return;
  const auto block_of = [&](const Cell& cell) {
    return Cell{(cell.column - window_.first.column) >> kBlockShift,
                (cell.row - window_.first.row) >> kBlockShift};
  };
  const Cell low = block_of(cells.low);
  const Cell high = block_of(cells.high);
  for (std::int32_t row = low.row; row <= high.row; ++row)
    for (std::int32_t column = low.column; column <= high.column; ++column)
      free_occupied_in_block(body, column, row);
  lasting_.drive_over(body);
}

void EvidenceGrid::free_occupied_in_block(const Box& box, std::int32_t block_column,
                                          std::int32_t block_row) {
  std::uint64_t bits = occupied_bits_[static_cast<std::size_t>(block_row) *
                                          static_cast<std::size_t>(block_columns_) +
                                      static_cast<std::size_t>(block_column)];
  for (; bits != 0; bits &= bits - 1) {
    const std::int32_t bit = std::countr_zero(bits);
    const Cell cell{window_.first.column + (block_column << kBlockShift) + (bit & kInBlock),
                    window_.first.row + (block_row << kBlockShift) + (bit >> kBlockShift)};
    if (box.covers(window_.centre_of(cell))) raise_so(cell, -free_steps_);
  }
}

int EvidenceGrid::highest_so_steps(Cell cell, int radius) const {
  if (!window_.contains(cell))
    return 0;  // Cells outside are unknown; far cells have no neighbours in the window, either.
  const GridWindow square{window_.cell_size_m,
                          {cell.column - radius, cell.row - radius},
                          2 * radius + 1,
                          2 * radius + 1};
  const bool is_inside =
      window_.contains(square.first) && window_.contains({cell.column + radius, cell.row + radius});
  const GridWindow inside = is_inside ? square : intersection(window_, square);
  int highest = is_inside ? std::numeric_limits<std::int8_t>::min() : 0;
  for (std::int32_t row = 0; row < inside.rows; ++row) {
    const std::int8_t* const cells =
        so_.data() + window_.index({inside.first.column, inside.first.row + row});
    for (std::int32_t column = 0; column < inside.columns; ++column)
      highest = std::max<int>(highest, cells[column]);
  }
  return highest;
}

void EvidenceGrid::BlockLanes::set(std::int32_t lane, std::int32_t block, bool is_occupied) {
  std::uint64_t& word =
      words[static_cast<std::size_t>(lane) * static_cast<std::size_t>(words_per_lane) +
            static_cast<std::size_t>(block >> 6)];
  const std::uint64_t bit = std::uint64_t{1} << (block & 63);
  word = is_occupied ? word | bit : word & ~bit;
}

/// True if any block of the range, within one word, is occupied.
bool EvidenceGrid::BlockLanes::may_have_any(std::int32_t lane, std::int32_t low,
                                            std::int32_t high) const {
  if ((low ^ high) >> 6 != 0) return true;
  const std::uint64_t from_low =
      words[static_cast<std::size_t>(lane * words_per_lane + (low >> 6))] >> (low & 63);
  return (from_low & ((std::uint64_t{2} << (high - low)) - 1)) != 0;
}

template <typename Visit>
bool EvidenceGrid::BlockLanes::any(std::int32_t lane, std::int32_t first, std::int32_t last,
                                   Visit visit) const {
  const auto [low, high] = std::minmax(first, last);
  if (!may_have_any(lane, low, high)) return false;
  const std::uint64_t* const of_lane =
      words.data() + static_cast<std::ptrdiff_t>(lane) * words_per_lane;
  const bool is_up = first <= last;
  const std::int32_t low_word = low >> 6;
  const std::int32_t high_word = high >> 6;
  for (std::int32_t i = 0; i <= high_word - low_word; ++i) {
    const std::int32_t word = is_up ? low_word + i : high_word - i;
    std::uint64_t blocks = of_lane[word];
    if (word == low_word) blocks &= ~std::uint64_t{0} << (low & 63);
    if (word == high_word) blocks &= ~std::uint64_t{0} >> (63 - (high & 63));
    while (blocks != 0) {
      const int place = is_up ? std::countr_zero(blocks) : 63 - std::countl_zero(blocks);
      if (visit((word << 6) + place)) return true;
      blocks &= ~(std::uint64_t{1} << place);
    }
  }
  return false;
}

/// Traverses lanes of blocks: rows or columns, whichever the ray crosses less often. In each lane
/// it tests the occupied blocks between the ray's entry and exit: two blocks on average of thirty
/// on the ray. Entry and exit are accumulated in fixed point; the search range is wider than the
/// rounding error. An extra block costs time but cannot change the result. See cast_a_scan of the
/// benchmark; this is most of a scan's polar map view.
double EvidenceGrid::distance_to_occupied(const Eigen::Vector2d& origin_m,
                                          const Eigen::Vector2d& direction,
                                          double max_range_m) const {
  constexpr double kPerBlock = 1.0 / (1 << kBlockShift);
  constexpr int kFractionBits = 32;
  constexpr std::int64_t kBesides = 1 << 13;  // of a block, in fixed point: a few hundred times the
                                              // largest rounding error
  const RayInCells ray(
      origin_m / window_.cell_size_m - Eigen::Vector2d(window_.first.column, window_.first.row),
      direction);
  const double max_range = max_range_m / window_.cell_size_m;
  const bool is_along_rows = std::abs(direction.x()) >= std::abs(direction.y());
  const RayInCells::Axis& along = is_along_rows ? ray.x : ray.y;
  const RayInCells::Axis& across = is_along_rows ? ray.y : ray.x;
  const BlockLanes& lanes = is_along_rows ? rows_of_blocks_ : columns_of_blocks_;
  const std::int32_t lane_count = is_along_rows ? block_rows_ : block_columns_;
  const std::int32_t last_block = (is_along_rows ? block_columns_ : block_rows_) - 1;
  const double end_of_lane = last_block + 1.0;
  std::int32_t lane = whole_below(across.start * kPerBlock);
  if (lane < 0 || lane >= lane_count) return max_range_m;
  if (!(along.start >= 0.0 && along.start * kPerBlock < end_of_lane)) return max_range_m;
  const auto place_after = [&](double way) {
    return (along.start + way * along.direction) * kPerBlock;
  };  // in blocks
  const auto in_fractions = [&](double place) {
    return static_cast<std::int64_t>(std::clamp(place, -1.0, end_of_lane + 1.0) *
                                     static_cast<double>(std::int64_t{1} << kFractionBits));
  };
  const auto block_at = [&](std::int64_t place) {
    return std::clamp(static_cast<std::int32_t>(place >> kFractionBits), 0, last_block);
  };
  const std::int64_t besides = along.step * kBesides;
  const std::int64_t end =
      in_fractions(std::clamp(place_after(max_range), 0.0, end_of_lane)) + besides;
  const std::int64_t per_lane =
      along.step * in_fractions(std::abs(along.direction * across.per_cell));
  std::int64_t enters = in_fractions(along.start * kPerBlock);
  std::int64_t leaves =
      across.direction != 0.0
          ? in_fractions(place_after(across.way_to((lane + (across.step > 0)) << kBlockShift)))
          : end + besides;
  double hit = 0.0;
  for (; lane >= 0 && lane < lane_count; lane += across.step) {
    const bool ends = along.step > 0 ? leaves - besides >= end : leaves - besides <= end;
    const bool is_found =
        lanes.any(lane, block_at(enters - besides), block_at((ends ? end : leaves) + besides),
                  [&](std::int32_t block) {
                    hit = is_along_rows ? ray_to_occupied_in_block(ray, block, lane)
                                        : ray_to_occupied_in_block(ray, lane, block);
                    return hit < max_range;
                  });
    if (is_found) return hit * window_.cell_size_m;
    if (ends) break;
    enters = leaves;
    leaves += per_lane;
  }
  return max_range_m;
}

/// Distance along the ray to the block's first occupied cell, in cells; infinite if there is none.
/// Cell traversal of Amanatides and Woo 1987.
double EvidenceGrid::ray_to_occupied_in_block(const RayInCells& ray, std::int32_t block_column,
                                              std::int32_t block_row) const {
  constexpr double kNever = std::numeric_limits<double>::infinity();
  constexpr std::int32_t kBlock = 1 << kBlockShift;
  const auto ways_through = [&](const RayInCells::Axis& axis, std::int32_t block) {
    const std::int32_t low = block << kBlockShift;
    return axis.step > 0 ? std::pair(axis.way_to(low), axis.way_to(low + kBlock))
                         : std::pair(axis.way_to(low + kBlock), axis.way_to(low));
  };
  const auto [enters_x, leaves_x] = ways_through(ray.x, block_column);
  const auto [enters_y, leaves_y] = ways_through(ray.y, block_row);
  double at = 0.0;
  if (enters_x < kNever) at = std::max(at, enters_x);
  if (enters_y < kNever) at = std::max(at, enters_y);
  if (at > std::min(leaves_x, leaves_y)) return kNever;
  const std::uint64_t bits = occupied_bits_[static_cast<std::size_t>(block_row) *
                                                static_cast<std::size_t>(block_columns_) +
                                            static_cast<std::size_t>(block_column)];
  // In cells of the block. Clamped against rounding at the entry.
  const RayInCells inside(
      {ray.x.start - (block_column << kBlockShift), ray.y.start - (block_row << kBlockShift)}, ray);
  const auto entry = [&](const RayInCells::Axis& axis) {
    return static_cast<std::int32_t>(
        std::clamp(axis.start + at * axis.direction, 0.0, kBlock - 1.0));
  };
  std::int32_t column = entry(inside.x);
  std::int32_t row = entry(inside.y);
  double next_column = inside.x.way_to(column + (ray.x.step > 0));
  double next_row = inside.y.way_to(row + (ray.y.step > 0));
  while (((column | row) & ~kInBlock) == 0) {
    if (bits >> ((row << kBlockShift) | column) & 1) return at;
    const bool by_column = next_column < next_row;
    at = by_column ? next_column : next_row;
    column += by_column ? ray.x.step : 0;
    row += by_column ? 0 : ray.y.step;
    next_column += by_column ? std::abs(ray.x.per_cell) : 0.0;
    next_row += by_column ? 0.0 : std::abs(ray.y.per_cell);
  }
  return kNever;
}

EvidenceGrid EvidenceGrid::moved_to(const GridWindow& window) const {
  assert(window.cell_size_m == window_.cell_size_m);
  EvidenceGrid moved(window, model_, lasting_.model());
  const GridWindow shared = intersection(window, window_);
  for (std::int32_t row = 0; row < shared.rows; ++row) {
    const Cell cell{shared.first.column, shared.first.row + row};
    const std::size_t from = window_.index(cell);
    const std::size_t to = window.index(cell);
    std::copy_n(so_.data() + from, shared.columns, moved.so_.data() + to);
    std::copy_n(mo_.data() + from, shared.columns, moved.mo_.data() + to);
    moved.lasting_.copy_from(lasting_, from, shared.columns, to);
  }
  moved.note_all_occupied();
  return moved;
}

void EvidenceGrid::set_cells(std::vector<std::int8_t> so, std::vector<std::uint8_t> mo,
                             std::vector<std::int8_t> lasting) {
  assert(so.size() == window_.cell_count() && mo.size() == window_.cell_count());
  so_ = std::move(so);
  lowest_.clear_all();
  mo_ = std::move(mo);
  lasting_.set_cells(std::move(lasting));
  std::fill(occupied_bits_.begin(), occupied_bits_.end(), 0);
  rows_of_blocks_ = BlockLanes(block_rows_, block_columns_);
  columns_of_blocks_ = BlockLanes(block_columns_, block_rows_);
  note_all_occupied();
}

/// Precondition: no cell is noted as occupied yet. Most cells are free or unseen, so that whole
/// runs are skipped.
void EvidenceGrid::note_all_occupied() {
  constexpr std::size_t kRun = 64;
  for (std::size_t run = 0; run < so_.size(); run += kRun) {
    const std::size_t end = std::min(run + kRun, so_.size());
    std::int8_t highest = std::numeric_limits<std::int8_t>::min();
    for (std::size_t i = run; i < end; ++i) highest = std::max(highest, so_[i]);
    if (highest < occupied_steps_) continue;
    const auto columns = static_cast<std::size_t>(window_.columns);
    for (std::size_t i = run; i < end; ++i) {
      if (so_[i] >= occupied_steps_)
        note_occupied(static_cast<std::int32_t>(i % columns),
                      static_cast<std::int32_t>(i / columns));
    }
  }
}

}  // namespace slammot::grids
