#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace slammot::loop_closing {

/// State of a cell. In a union of submaps the greater value wins.
enum class CellState : std::uint8_t { kUnknown, kFree, kOccupied };

/// Grid of cell states, two bits each, in blocks of 16 by 16 cells. Blocks that are unknown
/// throughout take no memory: of a submap's rectangle that is most.
class CellStates {
 public:
  CellStates() = default;
  /// All unknown.
  CellStates(std::int32_t columns, std::int32_t rows);

  std::int32_t columns() const { return columns_; }
  std::int32_t rows() const { return rows_; }

  /// Precondition: inside the grid.
  CellState at(std::int32_t column, std::int32_t row) const {
    const Block& block = blocks_[block_of_[index(column, row)]];
    const std::uint32_t line = block[static_cast<std::size_t>(row % kSide)];
    return static_cast<CellState>(line >> shift(column) & kMask);
  }
  /// Precondition: inside the grid.
  void set(std::int32_t column, std::int32_t row, CellState state);

  /// Blocks that take memory.
  std::size_t blocks() const { return blocks_.empty() ? 0 : blocks_.size() - 1; }

 private:
  static constexpr std::int32_t kSide = 16;
  static constexpr std::uint32_t kMask = 3;
  using Block = std::array<std::uint32_t, kSide>;  ///< A line a row, from the lowest bits.

  std::size_t index(std::int32_t column, std::int32_t row) const {
    return static_cast<std::size_t>(row / kSide) * static_cast<std::size_t>(block_columns_) +
           static_cast<std::size_t>(column / kSide);
  }
  static int shift(std::int32_t column) { return 2 * (column % kSide); }

  std::int32_t columns_ = 0;
  std::int32_t rows_ = 0;
  std::int32_t block_columns_ = 0;
  std::vector<std::uint32_t> block_of_;  ///< 0: the first block, unknown throughout.
  std::vector<Block> blocks_;
};

}  // namespace slammot::loop_closing
