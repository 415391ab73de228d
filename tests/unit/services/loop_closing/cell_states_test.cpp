#include "services/loop_closing/cell_states.hpp"

#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace slammot::loop_closing {
namespace {

TEST(CellStates, HoldsWhatWasSet) {
  constexpr std::int32_t kColumns = 70;
  constexpr std::int32_t kRows = 33;
  CellStates states(kColumns, kRows);
  std::vector<CellState> expected(static_cast<std::size_t>(kColumns * kRows), CellState::kUnknown);
  std::mt19937 random(7);
  for (int i = 0; i < 5000; ++i) {
    const auto column = static_cast<std::int32_t>(random() % kColumns);
    const auto row = static_cast<std::int32_t>(random() % kRows);
    const auto state = static_cast<CellState>(random() % 3);
    states.set(column, row, state);
    expected[static_cast<std::size_t>(row * kColumns + column)] = state;
  }
  for (const bool shares : {false, true}) {
    if (shares) states.share_blocks();
    for (std::int32_t row = 0; row < kRows; ++row) {
      for (std::int32_t column = 0; column < kColumns; ++column)
        ASSERT_EQ(states.at(column, row),
                  expected[static_cast<std::size_t>(row * kColumns + column)])
            << column << ", " << row;
    }
  }
}

TEST(CellStates, StoresEqualBlocksOnce) {
  CellStates states(256, 64);
  for (std::int32_t row = 0; row < 64; ++row) {
    for (std::int32_t column = 0; column < 256; ++column) states.set(column, row, CellState::kFree);
  }
  states.set(200, 40, CellState::kOccupied);
  const std::size_t bytes_before = states.bytes();
  EXPECT_EQ(states.blocks(), 256U);
  states.share_blocks();
  EXPECT_EQ(states.blocks(), 2U) << "free throughout, and the one with a wall";
  EXPECT_LT(states.bytes(), bytes_before / 2);
  EXPECT_EQ(states.at(200, 40), CellState::kOccupied);
  EXPECT_EQ(states.at(208, 40), CellState::kFree);
  CellStates none;
  none.share_blocks();
  EXPECT_EQ(none.blocks(), 0U);
}

TEST(CellStates, TakesNoMemoryForWhatIsUnknown) {
  CellStates states(1000, 1000);
  EXPECT_EQ(states.blocks(), 0U);
  EXPECT_EQ(states.at(999, 999), CellState::kUnknown);
  states.set(999, 999, CellState::kFree);
  states.set(992, 992, CellState::kOccupied);
  EXPECT_EQ(states.blocks(), 1U);
  states.set(991, 992, CellState::kOccupied);
  EXPECT_EQ(states.blocks(), 2U);
  EXPECT_EQ(CellStates().blocks(), 0U);
}

}  // namespace
}  // namespace slammot::loop_closing
