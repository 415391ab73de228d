#include "common/matching/score_pyramid.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

#include <Eigen/Geometry>

#include "common/matching/smear_kernel.hpp"

namespace slammot::matching {
namespace {

constexpr std::int32_t kPad = 8;  // entries on each side whose window still overlaps the grid

int stride_shift(int level) { return std::max(level - ScorePyramid::kStrideFiner, 0); }

/// Largest displacement of a point, in cells, over the headings of a block of this level.
std::int32_t cells_by_heading(int level) { return ScorePyramid::headings_of(level) / 2; }

}  // namespace

ScorePyramid::ScorePyramid(std::span<const TargetPoint> points, double cell_m, double smear_sigma_m,
                           int top_level)
    : cell_m_(cell_m) {
  assert(cell_m > 0.0 && smear_sigma_m > 0.0 && top_level >= 0);
  stamp(points, smear_sigma_m);
  Level blocks = levels_.front();
  for (int level = 1; level <= top_level; ++level) {
    if (stride_shift(level) > stride_shift(level - 1)) blocks = halved(blocks);
    append_level(blocks, level);
  }
}

/// Maxima over 2 x 2 entries.
ScorePyramid::Level ScorePyramid::halved(const Level& fine) {
  Level coarse{.columns = (fine.columns + 1) / 2 + kPad, .rows = (fine.rows + 1) / 2 + kPad};
  coarse.values.assign(
      static_cast<std::size_t>(coarse.columns) * static_cast<std::size_t>(coarse.rows), 0);
  for (std::int32_t row = kPad; row < fine.rows; ++row) {
    const std::uint8_t* from = fine.values.data() + static_cast<std::ptrdiff_t>(row) * fine.columns;
    std::uint8_t* to = coarse.values.data() +
                       static_cast<std::ptrdiff_t>((row - kPad) / 2 + kPad) * coarse.columns;
    for (std::int32_t column = kPad; column < fine.columns; ++column) {
      std::uint8_t& value = to[(column - kPad) / 2 + kPad];
      value = std::max(value, from[column]);
    }
  }
  work_ += fine.values.size();
  return coarse;
}

void ScorePyramid::stamp(std::span<const TargetPoint> points, double smear_sigma_m) {
  const SmearKernel kernel(cell_m_, smear_sigma_m);
  Eigen::AlignedBox2d box;
  for (const TargetPoint& point : points) box.extend(geometry::Vector2(point.x_m, point.y_m));
  Level& grid = levels_.emplace_back();
  if (points.empty()) return;
  origin_m_ = box.min().array() - kernel.half() * cell_m_;
  const geometry::Vector2 size = in_cells(box.max());
  grid.columns = static_cast<std::int32_t>(size.x()) + kernel.half() + 1 + 2 * kPad;
  grid.rows = static_cast<std::int32_t>(size.y()) + kernel.half() + 1 + 2 * kPad;
  grid.values.assign(static_cast<std::size_t>(grid.columns) * static_cast<std::size_t>(grid.rows),
                     0);
  const std::int32_t side = 2 * kernel.half() + 1;
  for (const TargetPoint& point : points) {
    const geometry::Vector2 at = in_cells({point.x_m, point.y_m});
    const auto column = static_cast<std::int32_t>(std::floor(at.x()));
    const auto row = static_cast<std::int32_t>(std::floor(at.y()));
    const std::uint8_t* values = kernel.around(at - geometry::Vector2(column, row));
    const auto weight_256 =
        static_cast<std::uint32_t>(std::lround(256.0F * std::clamp(point.weight, 0.0F, 1.0F)));
    for (std::int32_t y = 0; y < side; ++y) {
      std::uint8_t* cells =
          grid.values.data() +
          static_cast<std::ptrdiff_t>(row + y - kernel.half() + kPad) * grid.columns + column -
          kernel.half() + kPad;
      for (std::int32_t x = 0; x < side; ++x)
        cells[x] =
            std::max(cells[x], static_cast<std::uint8_t>((values[y * side + x] * weight_256) >> 8));
    }
  }
  work_ += grid.values.size() / 8 + points.size() * static_cast<std::size_t>(side * side);
}

/// blocks: maxima over the stride. An entry's window covers the cells of every pose in the entry.
void ScorePyramid::append_level(const Level& blocks, int level) {
  const std::int32_t stride = 1 << stride_shift(level);
  const std::int32_t first = -((cells_by_heading(level) + stride - 1) / stride);
  const std::int32_t last = (stride - 1 + (1 << level) - 1 + cells_by_heading(level)) / stride;
  Level along = blocks;
  for (std::int32_t row = 0; row < blocks.rows; ++row) {
    const std::uint8_t* from =
        blocks.values.data() + static_cast<std::ptrdiff_t>(row) * blocks.columns;
    std::uint8_t* to = along.values.data() + static_cast<std::ptrdiff_t>(row) * blocks.columns;
    for (std::int32_t step = first; step <= last; ++step) {
      const std::int32_t begin = std::max(-step, 0);
      const std::int32_t end = blocks.columns - std::max(step, 0);
      for (std::int32_t column = begin; column < end; ++column)
        to[column] = std::max(to[column], from[column + step]);
    }
  }
  Level both = along;
  for (std::int32_t row = 0; row < blocks.rows; ++row) {
    std::uint8_t* to = both.values.data() + static_cast<std::ptrdiff_t>(row) * blocks.columns;
    for (std::int32_t step = first; step <= last; ++step) {
      if (row + step < 0 || row + step >= blocks.rows) continue;
      const std::uint8_t* from =
          along.values.data() + static_cast<std::ptrdiff_t>(row + step) * blocks.columns;
      for (std::int32_t column = 0; column < blocks.columns; ++column)
        to[column] = std::max(to[column], from[column]);
    }
  }
  work_ += blocks.values.size();
  levels_.push_back(std::move(both));
}

std::uint32_t ScorePyramid::sum(const CellPoints& points, std::int32_t column, std::int32_t row,
                                int level) const {
  const Level& grid = levels_[static_cast<std::size_t>(level)];
  const int shift = stride_shift(level);
  const auto columns = static_cast<std::uint32_t>(grid.columns);
  const auto rows = static_cast<std::uint32_t>(grid.rows);
  const std::uint8_t* values = grid.values.data();
  std::uint32_t sum = 0;
  for (std::size_t i = 0; i < points.columns.size(); ++i) {
    const auto x = static_cast<std::uint32_t>(((points.columns[i] + column) >> shift) + kPad);
    const auto y = static_cast<std::uint32_t>(((points.rows[i] + row) >> shift) + kPad);
    if (x < columns && y < rows) sum += values[y * columns + x];
  }
  return sum;
}

std::array<std::uint32_t, 4> ScorePyramid::sums_of_four(const CellPoints& points,
                                                        std::int32_t column, std::int32_t row,
                                                        std::int32_t step, int level) const {
  const Level& grid = levels_[static_cast<std::size_t>(level)];
  const int shift = stride_shift(level);
  const auto columns = static_cast<std::uint32_t>(grid.columns);
  const auto rows = static_cast<std::uint32_t>(grid.rows);
  const std::uint8_t* values = grid.values.data();
  std::array<std::uint32_t, 4> sums{};
  for (std::size_t i = 0; i < points.columns.size(); ++i) {
    const std::int32_t at_column = points.columns[i] + column;
    const std::int32_t at_row = points.rows[i] + row;
    const auto left = static_cast<std::uint32_t>((at_column >> shift) + kPad);
    const auto right = static_cast<std::uint32_t>(((at_column + step) >> shift) + kPad);
    const auto lower = static_cast<std::uint32_t>((at_row >> shift) + kPad);
    const auto upper = static_cast<std::uint32_t>(((at_row + step) >> shift) + kPad);
    if (lower < rows) {
      if (left < columns) sums[0] += values[lower * columns + left];
      if (right < columns) sums[1] += values[lower * columns + right];
    }
    if (upper < rows) {
      if (left < columns) sums[2] += values[upper * columns + left];
      if (right < columns) sums[3] += values[upper * columns + right];
    }
  }
  return sums;
}

}  // namespace slammot::matching
