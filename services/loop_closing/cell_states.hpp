#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace slammot::loop_closing {

/// State of a cell. In a union of submaps the greater value wins.
enum class CellState : std::uint8_t { kUnknown, kFree, kOccupied };

/// Grid of cell states, two bits each, in blocks of 8 by 8 cells within regions of 32 by 32 cells.
/// Regions and blocks that are unknown throughout take no memory, which is most of a submap's
/// rectangle; share_blocks() stores equal blocks, mostly free ones, once.
class CellStates {
 public:
  CellStates() = default;
  /// All unknown.
  CellStates(std::int32_t columns, std::int32_t rows);

  std::int32_t columns() const { return columns_; }
  std::int32_t rows() const { return rows_; }

  /// Precondition: inside the grid.
  CellState at(std::int32_t column, std::int32_t row) const {
    const Region& region = regions_[region_of_[region_index(column, row)]];
    const Block& block = blocks_[region[block_index(column, row)]];
    return static_cast<CellState>(block[static_cast<std::size_t>(row % kBlock)] >> shift(column) &
                                  kMask);
  }
  /// Preconditions: inside the grid; share_blocks() was not called.
  void set(std::int32_t column, std::int32_t row, CellState state);

  /// Stores equal blocks once and frees spare memory. The states do not change; call it after the
  /// last set().
  void share_blocks();

  /// Blocks that take memory.
  std::size_t blocks() const { return blocks_.empty() ? 0 : blocks_.size() - 1; }
  /// Memory in use.
  std::size_t bytes() const;

 private:
  static constexpr std::int32_t kBlock = 8;   // cells along a side
  static constexpr std::int32_t kRegion = 4;  // blocks along a side
  static constexpr std::int32_t kRegionCells = kBlock * kRegion;
  static constexpr std::uint32_t kMask = 3;
  using Block = std::array<std::uint16_t, kBlock>;  ///< A line a row, from the lowest bits.
  using Region = std::array<std::uint32_t, std::size_t{kRegion} * kRegion>;  ///< Blocks, row-major.

  std::size_t region_index(std::int32_t column, std::int32_t row) const {
    return static_cast<std::size_t>(row / kRegionCells) *
               static_cast<std::size_t>(region_columns_) +
           static_cast<std::size_t>(column / kRegionCells);
  }
  static std::size_t block_index(std::int32_t column, std::int32_t row) {
    return static_cast<std::size_t>(row / kBlock % kRegion * kRegion + column / kBlock % kRegion);
  }
  static int shift(std::int32_t column) { return 2 * (column % kBlock); }

  std::int32_t columns_ = 0;
  std::int32_t rows_ = 0;
  std::int32_t region_columns_ = 0;
  bool is_shared_ = false;
  std::vector<std::uint32_t> region_of_;
  std::vector<Region> regions_;  ///< The first one is unknown throughout.
  std::vector<Block> blocks_;    ///< The first one is unknown throughout.
};

}  // namespace slammot::loop_closing
