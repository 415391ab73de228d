#include "services/loop_closing/cell_states.hpp"

#include <cassert>
#include <map>
#include <utility>

namespace slammot::loop_closing {

CellStates::CellStates(std::int32_t columns, std::int32_t rows)
    : columns_(columns),
      rows_(rows),
      region_columns_((columns + kRegionCells - 1) / kRegionCells),
      region_of_(static_cast<std::size_t>(region_columns_) *
                 static_cast<std::size_t>((rows + kRegionCells - 1) / kRegionCells)),
      regions_(1),
      blocks_(1) {}

void CellStates::set(std::int32_t column, std::int32_t row, CellState state) {
  assert(!is_shared_);
  std::uint32_t& region = region_of_[region_index(column, row)];
  if (region == 0) {
    region = static_cast<std::uint32_t>(regions_.size());
    regions_.emplace_back();
  }
  std::uint32_t& block = regions_[region][block_index(column, row)];
  if (block == 0) {
    block = static_cast<std::uint32_t>(blocks_.size());
    blocks_.emplace_back();
  }
  std::uint16_t& line = blocks_[block][static_cast<std::size_t>(row % kBlock)];
  line = static_cast<std::uint16_t>((line & ~(kMask << shift(column))) |
                                    static_cast<std::uint32_t>(state) << shift(column));
}

void CellStates::share_blocks() {
  std::map<Block, std::uint32_t> known;
  std::vector<Block> distinct;
  std::vector<std::uint32_t> new_index;
  new_index.reserve(blocks_.size());
  for (const Block& block : blocks_) {
    const auto [entry, is_new] =
        known.try_emplace(block, static_cast<std::uint32_t>(distinct.size()));
    if (is_new) distinct.push_back(block);
    new_index.push_back(entry->second);
  }
  for (Region& region : regions_) {
    for (std::uint32_t& block : region) block = new_index.empty() ? 0 : new_index[block];
  }
  distinct.shrink_to_fit();
  blocks_ = std::move(distinct);
  regions_.shrink_to_fit();
  is_shared_ = true;
}

std::size_t CellStates::bytes() const {
  return region_of_.capacity() * sizeof(std::uint32_t) + regions_.capacity() * sizeof(Region) +
         blocks_.capacity() * sizeof(Block);
}

}  // namespace slammot::loop_closing
