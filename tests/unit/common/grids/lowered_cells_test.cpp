#include "common/grids/lowered_cells.hpp"

#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace slammot::grids {
namespace {

constexpr int kSteps = 3;
constexpr int kLowest = -50;

std::int8_t lowered(std::int8_t cell) {
  return static_cast<std::int8_t>(std::min<int>(cell, std::max(cell - kSteps, kLowest)));
}

TEST(LowerCells, LowersThoseOfWhichTheBitIsSetAndTellsWhichCannotBeLoweredAnyMore) {
  std::mt19937_64 random(1);
  std::uniform_int_distribution<int> any(-128, 127);
  for (const std::int32_t count : {64, 48, 37, 5}) {
    for (const std::uint64_t bits : {std::uint64_t{0}, ~std::uint64_t{0}, std::uint64_t{0xff00},
                                     random(), random() & random() & random()}) {
      std::vector<std::int8_t> cells(static_cast<std::size_t>(count));
      for (std::int8_t& cell : cells)
        cell = static_cast<std::int8_t>(random() % 2 ? any(random)
                                                     : kLowest + static_cast<int>(random() % 5));
      const std::vector<std::int8_t> before = cells;
      const std::uint64_t cannot_be_lowered =
          lower_cells(cells.data(), count, bits, kSteps, kLowest);
      for (std::int32_t i = 0; i < count; ++i) {
        const auto at = static_cast<std::size_t>(i);
        const bool is_to_be_lowered = bits >> i & 1;
        const bool is_told = cannot_be_lowered >> i & 1;
        EXPECT_EQ(cells[at], is_to_be_lowered ? lowered(before[at]) : before[at]);
        if (is_to_be_lowered) EXPECT_EQ(is_told, cells[at] <= kLowest);
        if (is_told) EXPECT_LE(cells[at], kLowest);
      }
    }
  }
}

}  // namespace
}  // namespace slammot::grids
