#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "common/grids/bit_rows.hpp"
#include "common/grids/box.hpp"
#include "common/grids/grid_window.hpp"
#include "common/grids/log_odds.hpp"

namespace slammot::grids {

struct LastingModel {
  double hit_log_odds = 0.4;        ///< Added where a stationary echo ended.
  double free_log_odds = 0.4;       ///< Taken off where a beam and those beside it passed, once a scan and cell.
  double limit_log_odds = 5.0;      ///< No cell is surer than this, but for one that was driven over.
};

/// What is to be kept of a place. The SO-map has to know at once what is new, so that an echo outweighs the beams that pass: those
/// pass beside walls, too, where cells are coarse. Here a beam counts as much as an echo, and only as far as those beside it go,
/// so that what stands loses next to nothing by it. See docs/decisions/maps-and-submaps.md.
class LastingEvidence {
 public:
  LastingEvidence() = default;
  LastingEvidence(const GridWindow& window, const LastingModel& model);

  const LastingModel& model() const { return model_; }

  /// An echo came from this cell of the window. Nothing raises what was driven over.
  void hit(Cell cell);

  /// A scan surely sees through these cells. Clears them.
  void pass(BitRows& surely_free);

  /// A body is here that surely moves: what is occupied loses as much as by a beam that passes, and what lies well inside beyond the
  /// limit, too. After so many scans of it that a byte holds no more the cell is driven over for good.
  void drive_over(const Box& body);

  static bool is_driven_over(std::int8_t steps) { return steps == kDrivenOver; }

  /// Row-major. set_cells needs as many as the window has.
  const std::vector<std::int8_t>& cells() const { return cells_; }
  void set_cells(std::vector<std::int8_t> cells);
  /// Into cells that are as they were made.
  void copy_from(const LastingEvidence& other, std::size_t from, std::int32_t count, std::size_t to);

 private:
  static constexpr std::int8_t kDrivenOver = -127;

  LastingModel model_;
  int hit_steps_ = 0;
  int free_steps_ = 0;
  int limit_steps_ = 0;
  GridWindow window_;
  std::vector<std::int8_t> cells_;
  BitRows lowest_;   ///< Cells that are known to be as low as beams can make them: nearly all that a scan sees through.
};

}  // namespace slammot::grids
