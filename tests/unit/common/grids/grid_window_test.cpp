#include "common/grids/grid_window.hpp"

#include <cmath>

#include <gtest/gtest.h>

namespace slammot::grids {
namespace {

TEST(GridWindow, PutsEachPointIntoTheCellWhoseLowerCornerIsNotAboveIt) {
  const GridWindow window{.cell_size_m = 0.25};
  EXPECT_EQ(window.cell_at(0.0, 0.0), (Cell{0, 0}));
  EXPECT_EQ(window.cell_at(0.24, -0.01), (Cell{0, -1}));
  EXPECT_EQ(window.cell_at(0.25, -0.25), (Cell{1, -1}));
  EXPECT_EQ(window.cell_at(-0.26, 10.0), (Cell{-2, 40}));
}

TEST(WholeBelow, RoundsDownAsFloorDoes) {
  for (const double place :
       {0.0, -0.0, 0.5, 1.0, -0.5, -1.0, -1.0000000000000002, 41.999999999999993, -7e8,
        2147483646.5, -2147483647.5, -2147483648.0}) {
    EXPECT_EQ(whole_below(place), static_cast<std::int32_t>(std::floor(place))) << place;
  }
}

TEST(GridWindow, FindsTheCentreOfACellInThatCell) {
  const GridWindow window{.cell_size_m = 0.2};
  for (int i = -50; i < 50; ++i) {
    const Eigen::Vector2d centre_m = window.centre_of({i, -3 * i});
    EXPECT_EQ(window.cell_at(centre_m.x(), centre_m.y()), (Cell{i, -3 * i}));
  }
}

TEST(GridWindow, GivesEachOfItsCellsAPlaceOfItsOwnRowByRow) {
  const GridWindow window{.cell_size_m = 0.2, .first = {-3, 5}, .columns = 4, .rows = 3};
  std::size_t expected = 0;
  for (int row = 5; row < 8; ++row) {
    for (int column = -3; column < 1; ++column) {
      EXPECT_TRUE(window.contains({column, row}));
      EXPECT_EQ(window.index({column, row}), expected++);
    }
  }
  EXPECT_EQ(window.cell_count(), expected);
}

TEST(GridWindow, DoesNotContainItsNeighbours) {
  const GridWindow window{.cell_size_m = 0.2, .first = {-3, 5}, .columns = 4, .rows = 3};
  for (const Cell& cell : {Cell{-4, 5}, Cell{1, 5}, Cell{-3, 4}, Cell{-3, 8}})
    EXPECT_FALSE(window.contains(cell));
}

TEST(GridWindow, ContainsNothingAtTheEndsOfTheLattice) {
  constexpr std::int32_t kLowest = std::numeric_limits<std::int32_t>::min();
  constexpr std::int32_t kHighest = std::numeric_limits<std::int32_t>::max();
  const GridWindow window{.cell_size_m = 0.2, .first = {-3, 5}, .columns = 4, .rows = 3};
  EXPECT_FALSE(window.contains({kLowest, kLowest}));
  EXPECT_FALSE(window.contains({kHighest, kHighest}));
}

TEST(WindowAround, HoldsThePointInItsMiddle) {
  const GridWindow window = window_around({10.03, -20.01}, 12.0, 0.2);
  EXPECT_EQ(window.columns, 60);
  EXPECT_EQ(window.rows, 60);
  const Cell middle{window.first.column + 30, window.first.row + 30};
  EXPECT_EQ(middle, window.cell_at(10.03, -20.01));
}

TEST(Intersection, IsTheSameBothWays) {
  const GridWindow a = window_around({0.0, 0.0}, 10.0, 0.25);
  const GridWindow b = window_around({3.0, -4.0}, 6.0, 0.25);
  EXPECT_EQ(intersection(a, b), intersection(b, a));
}

TEST(Intersection, HoldsExactlyTheCellsOfBoth) {
  const GridWindow a = window_around({0.0, 0.0}, 10.0, 0.25);
  const GridWindow b = window_around({3.0, -4.0}, 6.0, 0.25);
  const GridWindow shared = intersection(a, b);
  for (int row = -60; row < 60; ++row) {
    for (int column = -60; column < 60; ++column) {
      const Cell cell{column, row};
      ASSERT_EQ(shared.contains(cell), a.contains(cell) && b.contains(cell));
    }
  }
}

TEST(Intersection, OfWindowsFarApartHasNoCells) {
  const GridWindow shared =
      intersection(window_around({0.0, 0.0}, 10.0, 0.25), window_around({100.0, 0.0}, 10.0, 0.25));
  EXPECT_EQ(shared.cell_count(), 0U);
}

}  // namespace
}  // namespace slammot::grids
