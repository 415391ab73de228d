#include "services/loop_closing/cell_states.hpp"

namespace slammot::loop_closing {

CellStates::CellStates(std::int32_t columns, std::int32_t rows)
    : columns_(columns),
      rows_(rows),
      block_columns_((columns + kSide - 1) / kSide),
      block_of_(static_cast<std::size_t>(block_columns_) *
                static_cast<std::size_t>((rows + kSide - 1) / kSide)),
      blocks_(1) {}

void CellStates::set(std::int32_t column, std::int32_t row, CellState state) {
  std::uint32_t& block = block_of_[index(column, row)];
  if (block == 0) {
    block = static_cast<std::uint32_t>(blocks_.size());
    blocks_.emplace_back();
  }
  std::uint32_t& line = blocks_[block][static_cast<std::size_t>(row % kSide)];
  line &= ~(kMask << shift(column));
  line |= static_cast<std::uint32_t>(state) << shift(column);
}

}  // namespace slammot::loop_closing
