#include "services/gateway/submap_view.hpp"

#include <gtest/gtest.h>

#include "services/gateway/map_view.hpp"

namespace slammot::gateway {
namespace {

flow::Submap submap_of(std::uint32_t columns, std::uint32_t rows) {
  flow::Submap submap;
  submap.cell_size_m = 0.5;
  submap.columns = columns;
  submap.rows = rows;
  submap.so_log_odds.assign(std::size_t{columns} * rows, 0);
  submap.mo_evidence.assign(submap.so_log_odds.size(), 0);
  return submap;
}

TEST(ReducedSubmap, IsCutToWhatWasSeen) {
  flow::Submap submap = submap_of(10, 8);
  submap.so_log_odds[3 * 10 + 4] = 50;
  submap.mo_evidence[5 * 10 + 6] = 9;
  const flow::Submap view = reduced(submap);
  EXPECT_EQ(view.columns, 3U);
  EXPECT_EQ(view.rows, 3U);
  EXPECT_DOUBLE_EQ(view.min_x_m, 2.0);
  EXPECT_DOUBLE_EQ(view.min_y_m, 1.5);
  EXPECT_EQ(view.so_log_odds[0], 50);
  EXPECT_EQ(view.mo_evidence[8], 9);
}

TEST(ReducedSubmap, KeepsAThinWallWhenCellsAreMerged) {
  flow::Submap submap = submap_of(40, 40);
  std::fill(submap.so_log_odds.begin(), submap.so_log_odds.end(), std::int8_t{-20});
  for (std::size_t row = 0; row < 40; ++row) submap.so_log_odds[row * 40 + 13] = 60;
  const flow::Submap view = reduced(submap, 100);
  EXPECT_EQ(view.columns, 10U);
  EXPECT_DOUBLE_EQ(view.cell_size_m, 2.0);
  for (std::size_t row = 0; row < 10; ++row) {
    EXPECT_EQ(view.so_log_odds[row * 10 + 3], 60);
    EXPECT_EQ(view.so_log_odds[row * 10 + 4], -20);
  }
}

TEST(ReducedSubmap, IsEmptyWhereNothingWasSeen) {
  const flow::Submap view = reduced(submap_of(5, 5));
  EXPECT_EQ(view.columns * view.rows, 0U);
}

TEST(MapView, MovesTheWayWithItsSubmap) {
  MapView view({1});
  flow::LocalizedScan scan;
  scan.submap_id = {3};
  scan.submap_from_base = {1.0, 0.0, 0.0};
  scan.odom_from_base.pose = {1.0, 0.0, 0.0};
  view.follow(scan);
  flow::GraphCorrection correction;
  correction.submaps = {{{3}, {10.0, 5.0, 0.0}}};
  view.correct(correction);
  ASSERT_EQ(view.way().size(), 1U);
  EXPECT_DOUBLE_EQ(view.way()[0].x_m, 11.0);
  EXPECT_DOUBLE_EQ(view.way()[0].y_m, 5.0);
}

TEST(MapView, ThinsALongWayOut) {
  MapView view({1});
  flow::LocalizedScan scan;
  for (int i = 0; i < 5000; ++i) {
    scan.submap_from_base.x_m = scan.odom_from_base.pose.x_m = i;
    view.follow(scan);
  }
  EXPECT_LE(view.way().size(), MapView::kMostPoses);
  EXPECT_GE(view.way().size(), MapView::kMostPoses / 2);
  EXPECT_GT(view.way().back().x_m, 4990.0);
}

}  // namespace
}  // namespace slammot::gateway
