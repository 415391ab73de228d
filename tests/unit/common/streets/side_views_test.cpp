#include "common/streets/side_views.hpp"

#include <cmath>

#include <gtest/gtest.h>

namespace slammot::streets {
namespace {

using geometry::Pose2;
using geometry::Vector2;

/// Walls everywhere but in streets, 16 m wide: one along x, 300 m long, and those that leave it.
struct Town {
  struct Side {
    double x_m = 0.0;
    double from_y_m = 0.0;
    double to_y_m = 0.0;
  };

  explicit Town(const std::vector<Side>& sides) {
    seen.min_m = {0.0, -60.0};
    seen.cell_m = 0.5;
    seen.columns = 600;
    seen.rows = 240;
    seen.cells.assign(seen.columns * seen.rows, Seen::kOccupied);
    clear({0.0, -8.0}, {300.0, 8.0}, Seen::kFree);
    for (const Side& side : sides)
      clear({side.x_m - 8.0, side.from_y_m}, {side.x_m + 8.0, side.to_y_m}, Seen::kFree);
  }

  void clear(const Vector2& low_m, const Vector2& high_m, Seen state) {
    for (double x_m = low_m.x() + 0.25; x_m < high_m.x(); x_m += seen.cell_m) {
      for (double y_m = low_m.y() + 0.25; y_m < high_m.y(); y_m += seen.cell_m) {
        const Vector2 cell = (Vector2(x_m, y_m) - seen.min_m) / seen.cell_m;
        seen.cells[static_cast<std::size_t>(cell.y()) * seen.columns +
                   static_cast<std::size_t>(cell.x())] = state;
      }
    }
  }

  std::vector<Opening> openings() const {
    std::vector<Pose2> way;
    for (double x_m = 10.0; x_m < 290.0; x_m += 1.0) way.push_back({x_m, -1.75, 0.0});
    return openings_of(side_views(seen, driven_way(way)));
  }

  SeenSpace seen;
};

TEST(SideViews, SeeAStreetToTheLeft) {
  const auto openings = Town({{120.0, 0.0, 60.0}}).openings();
  ASSERT_EQ(openings.size(), 1U);
  EXPECT_NEAR(openings[0].map_from_look.x_m, 120.0, 1.5);
  EXPECT_NEAR(openings[0].map_from_look.heading_rad, 0.5 * M_PI, 0.01);
}

TEST(SideViews, SeeAStreetThatCrossesToBothSides) {
  EXPECT_EQ(Town({{120.0, -60.0, 60.0}, {200.0, -60.0, 0.0}}).openings().size(), 3U);
}

TEST(SideViews, TakeAYardForNoStreet) {
  EXPECT_TRUE(Town({{120.0, 0.0, 20.0}}).openings().empty());
}

TEST(SideViews, TakeAGapBetweenHousesForNoStreet) {
  Town town({});
  town.clear({120.0, 0.0}, {124.0, 60.0}, Seen::kFree);
  EXPECT_TRUE(town.openings().empty());
}

TEST(SideViews, LookPastAPostInTheStreet) {
  Town town({{120.0, 0.0, 60.0}});
  town.clear({117.0, 10.0}, {118.0, 11.0}, Seen::kOccupied);
  ASSERT_EQ(town.openings().size(), 1U);
  EXPECT_NEAR(town.openings()[0].map_from_look.x_m, 120.0, 1.5);
}

TEST(SideViews, TellNothingWhereNothingWasSeen) {
  Town town({});
  town.clear({112.0, 9.0}, {128.0, 60.0}, Seen::kUnknown);
  EXPECT_TRUE(town.openings().empty());
}

TEST(SideViews, AreNoneWithoutAMap) { EXPECT_TRUE(side_views({}, {}).empty()); }

}  // namespace
}  // namespace slammot::streets
