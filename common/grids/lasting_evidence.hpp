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
  double echo_log_odds = 0.4;   ///< Added at a stationary echo, and subtracted where a beam and its
                                ///< neighbours passed, once a scan and cell.
  double limit_log_odds = 5.0;  ///< Limit of the absolute log-odds, except in cells that were
                                ///< driven over.
};

/// Occupancy that is stored in submaps. The SO-map must react fast, so that there an echo outweighs
/// passing beams. With coarse cells beams also pass beside walls. Here a beam counts as much as an
/// echo, but only as far as its neighbours reach, so that stationary objects lose almost no
/// evidence. See docs/decisions/maps-and-submaps.md.
class LastingEvidence {
 public:
  LastingEvidence() = default;
  LastingEvidence(const GridWindow& window, const LastingModel& model);

  const LastingModel& model() const { return model_; }

  /// Adds an echo in this cell of the window. A driven-over cell does not change.
  void hit(Cell cell);

  /// Lowers cells that a scan passes with certainty, and clears the mask.
  void pass(BitRows& surely_free);

  /// Lowers cells under a body that certainly moves. Occupied cells lose as much as by a passing
  /// beam; cells well inside fall below the limit, too. A cell at the lowest value of a byte is
  /// driven over and stays free.
  void drive_over(const Box& body);

  static bool is_driven_over(std::int8_t steps) { return steps == kDrivenOver; }

  /// Row-major. set_cells needs exactly as many as the window has.
  const std::vector<std::int8_t>& cells() const { return cells_; }
  void set_cells(std::vector<std::int8_t> cells);
  /// Precondition: the cells are in their initial state.
  void copy_from(const LastingEvidence& other, std::size_t from, std::int32_t count,
                 std::size_t to);

 private:
  static constexpr std::int8_t kDrivenOver = -127;

  LastingModel model_;
  int echo_steps_ = 0;
  int limit_steps_ = 0;
  GridWindow window_;
  std::vector<std::int8_t> cells_;
  BitRows lowest_;  ///< Cells at the lower limit: most of the cells that a scan passes.
};

}  // namespace slammot::grids
