#include "common/grids/lasting_evidence.hpp"

#include <algorithm>
#include <cmath>

#include "common/grids/lowered_cells.hpp"

namespace slammot::grids {
namespace {

constexpr double kWellInside_m = 0.4;  ///< Margin inside a body, for errors of its sides.

}  // namespace

LastingEvidence::LastingEvidence(const GridWindow& window, const LastingModel& model)
    : model_(model),
      echo_steps_(steps_of_log_odds(model.echo_log_odds)),
      limit_steps_(std::min(126, steps_of_log_odds(model.limit_log_odds))),
      window_(window),
      cells_(window.cell_count(), 0),
      lowest_(window.columns, window.rows) {}

void LastingEvidence::hit(Cell cell) {
  std::int8_t& steps = cells_[window_.index(cell)];
  if (is_driven_over(steps)) return;
  steps = static_cast<std::int8_t>(std::min(limit_steps_, steps + echo_steps_));
  lowest_.clear(cell.column - window_.first.column, cell.row - window_.first.row);
}

void LastingEvidence::pass(BitRows& surely_free) {
  surely_free.take_all([&](std::int32_t row, std::int32_t word, std::uint64_t passed) {
    std::uint64_t& lowest = lowest_.row(row)[word];
    const std::uint64_t to_lower = passed & ~lowest;
    if (to_lower == 0) return;
    const std::int32_t first_column = word * kCellsPerWord;
    std::int8_t* const cells =
        cells_.data() + static_cast<std::size_t>(row) * static_cast<std::size_t>(window_.columns) +
        static_cast<std::size_t>(first_column);
    lowest |= lower_cells(cells, std::min(kCellsPerWord, window_.columns - first_column), to_lower,
                          echo_steps_, -limit_steps_);
  });
}

void LastingEvidence::drive_over(const Box& body) {
  Box inside = body;
  inside.half_m -= Eigen::Vector2d::Constant(kWellInside_m);
  const CellRange cells = cells_around(body, window_);
  for (std::int32_t row = cells.low.row; row <= cells.high.row; ++row) {
    for (std::int32_t column = cells.low.column; column <= cells.high.column; ++column) {
      std::int8_t& cell = cells_[window_.index({column, row})];
      const Eigen::Vector2d centre_m = window_.centre_of({column, row});
      if (inside.covers(centre_m))
        cell = static_cast<std::int8_t>(std::max<int>(kDrivenOver, cell - echo_steps_));
      else if (cell > 0 && body.covers(centre_m))
        cell = static_cast<std::int8_t>(cell - echo_steps_);
    }
  }
}

void LastingEvidence::set_cells(std::vector<std::int8_t> cells) {
  cells_ = std::move(cells);
  lowest_.clear_all();
}

void LastingEvidence::copy_from(const LastingEvidence& other, std::size_t from, std::int32_t count,
                                std::size_t to) {
  std::copy_n(other.cells_.data() + from, count, cells_.data() + to);
}

}  // namespace slammot::grids
