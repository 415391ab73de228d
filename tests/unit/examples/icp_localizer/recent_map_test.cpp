#include "examples/icp_localizer/recent_map.hpp"

#include <cmath>

#include <gtest/gtest.h>

namespace slammot::icp_localizer {
namespace {

using flow::EndCell;
using geometry::Vector2;

constexpr double kStep_rad = M_PI / 180.0;

/// Echoes from the origin of odom: a quarter circle of wall 8 m away.
MappedScan round_wall(double travelled_m = 0.0, grids::Echo echo = grids::Echo::kStationary) {
  MappedScan scan;
  scan.beam_step_rad = kStep_rad;
  scan.travelled_m = travelled_m;
  for (int beam = -45; beam <= 45; ++beam)
    scan.rays.push_back(
        {8.0 * Vector2(std::cos(beam * kStep_rad), std::sin(beam * kStep_rad)), echo});
  return scan;
}

flow::LocalizedBeam end_at(const RecentMap& map, const Vector2& end_m) {
  flow::LocalizedBeam beam;
  map.look_up_end(end_m, beam);
  return beam;
}

TEST(RecentMap, DistinguishesFreeOccupiedAndUnseenCells) {
  RecentMap map({}, {}, Vector2::Zero());
  for (int scan = 0; scan < 10; ++scan) map.add(round_wall());
  EXPECT_EQ(end_at(map, {4.0, 0.0}).end_cell, EndCell::kFree);
  EXPECT_GT(end_at(map, {4.0, 0.0}).free_evidence, 0.0F);
  EXPECT_EQ(end_at(map, {8.0, 0.0}).end_cell, EndCell::kOccupied);
  EXPECT_EQ(end_at(map, {12.0, 0.0}).end_cell, EndCell::kUnseen);
  EXPECT_NEAR(map.expected_range_m(Vector2::Zero(), {1.0, 0.0}, 50.0), 8.0, 0.3);
  EXPECT_EQ(map.expected_range_m(Vector2::Zero(), {-1.0, 0.0}, 50.0), 50.0);
}

TEST(RecentMap, ExcludesMovingEchoesFromMatching) {
  RecentMap map({}, {}, Vector2::Zero());
  for (int scan = 0; scan < 10; ++scan) map.add(round_wall(0.0, grids::Echo::kMoving));
  EXPECT_TRUE(map.surfels().all().empty());
  EXPECT_NE(end_at(map, {8.0, 0.0}).end_cell, EndCell::kOccupied);
  EXPECT_GT(end_at(map, {8.0, 0.0}).moving_evidence, 0.5F);
}

TEST(RecentMap, BeginsTheNextOneWithItsLastScans) {
  RecentMap map({}, {3}, Vector2::Zero());
  for (int scan = 0; scan < 10; ++scan) map.add(round_wall(1.0 * scan));
  const RecentMap next = map.next({5.0, 0.0});
  EXPECT_EQ(next.id(), flow::SubmapId{4});
  EXPECT_FALSE(next.has_scans()) << "of its own";
  EXPECT_EQ(end_at(next, {8.0, 0.0}).end_cell, EndCell::kOccupied);
  EXPECT_EQ(end_at(next, {4.0, 0.0}).end_cell, EndCell::kFree);
  EXPECT_EQ(next.odom_from_submap().x_m, 5.0);
}

TEST(RecentMap, BecomesASubmapInItsOwnFrame) {
  const Vector2 centre_m(3.0, 1.0);
  RecentMap map({}, {}, centre_m);
  for (int scan = 0; scan < 10; ++scan) map.add(round_wall());
  const flow::Submap submap = map.submap();
  ASSERT_EQ(submap.so_log_odds.size(), std::size_t{submap.columns} * submap.rows);
  ASSERT_EQ(submap.mo_evidence.size(), submap.so_log_odds.size());
  const auto cell_at = [&](const Vector2& in_odom_m) {
    const Vector2 in_submap_m = in_odom_m - centre_m;
    const auto column = static_cast<std::size_t>(
        std::floor((in_submap_m.x() - submap.min_x_m) / submap.cell_size_m));
    const auto row = static_cast<std::size_t>(
        std::floor((in_submap_m.y() - submap.min_y_m) / submap.cell_size_m));
    return submap.so_log_odds.at(row * submap.columns + column);
  };
  EXPECT_LT(cell_at({4.1, 0.1}), 0);
  EXPECT_GT(cell_at({8.001, 0.05}), 0);
  ASSERT_FALSE(submap.surfels.empty());
  for (const flow::Surfel& surfel : submap.surfels)
    EXPECT_NEAR((Vector2(surfel.x_m, surfel.y_m) + centre_m).norm(), 8.0, 0.1);
}

}  // namespace
}  // namespace slammot::icp_localizer
