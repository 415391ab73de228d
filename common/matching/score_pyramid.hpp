#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "common/matching/correlative.hpp"

namespace slammot::matching {

/// Points rotated by one heading, in cells of a pyramid's finest grid.
struct CellPoints {
  std::vector<std::int32_t> columns;
  std::vector<std::int32_t> rows;
};

/// Likelihood of an echo around target points, with upper bounds for blocks of poses. Level k
/// bounds all shifts of [c, c + 2^k) x [r, r + 2^k) cells, at all headings that move no point by
/// more than 2^(k-1) cells (Hess et al., ICRA 2016, Section V.B, extended to headings as in Olson,
/// IJRR 2015). Coarse levels are stored at a stride of 2^(k-1) cells, so that the total is at
/// most 2.5 times the finest grid. Immutable.
class ScorePyramid {
 public:
  /// cell_m: cell of the finest grid. smear_sigma_m: sigma of the Gaussian around each point.
  /// top_level: level of the coarsest bounds.
  ScorePyramid(std::span<const TargetPoint> points, double cell_m, double smear_sigma_m,
               int top_level);

  static constexpr int kStrideFiner = 2;

  /// Number of heading steps in a block of this level; one step moves no point by more than a cell.
  static constexpr std::int32_t headings_of(int level) {
    return 1 << std::max(level - kHeadingFiner, 0);
  }
  static constexpr int kHeadingFiner = 1;

  int top_level() const { return static_cast<int>(levels_.size()) - 1; }
  double cell_m() const { return cell_m_; }

  /// Work to build it: cells read and written.
  std::uint64_t work() const { return work_; }

  /// Continuous cell coordinates of a point of the target frame; its cell is their floor.
  geometry::Vector2 in_cells(const geometry::Vector2& point_in_target_m) const {
    return (point_in_target_m - origin_m_) / cell_m_;
  }

  /// Sum over the points, each shifted by (column, row) cells: the exact score at level 0, the
  /// upper bound of the block at higher levels. At most SmearKernel::kFull a point.
  std::uint32_t sum(const CellPoints& points, std::int32_t column, std::int32_t row,
                    int level) const;

  /// Sums of four adjacent blocks: at (column, row), (column + step, row), (column, row + step),
  /// (column + step, row + step). It takes little longer than two single sums: search_a_wide_window
  /// of the benchmark.
  std::array<std::uint32_t, 4> sums_of_four(const CellPoints& points, std::int32_t column,
                                            std::int32_t row, std::int32_t step, int level) const;

 private:
  struct Level {
    std::int32_t columns = 0;
    std::int32_t rows = 0;
    std::vector<std::uint8_t> values = {};  ///< Row-major. Entry (i, j) is at cell (i - kPad, j -
                                            ///< kPad) * stride.
  };

  void stamp(std::span<const TargetPoint> points, double smear_sigma_m);
  Level halved(const Level& fine);
  void append_level(const Level& blocks, int level);

  double cell_m_;
  geometry::Vector2 origin_m_ = geometry::Vector2::Zero();  ///< Lower left corner of cell (0, 0).
  std::vector<Level> levels_;
  std::uint64_t work_ = 0;
};

}  // namespace slammot::matching
