#include "common/metrics/map_quality.hpp"

#include <gtest/gtest.h>

#include "tests/unit/common/metrics/scenes.hpp"

namespace slammot::metrics {
namespace {

constexpr double kToleranceM = 0.3;

/// 10 m x 10 m, all free, cells of 0.2 m from the origin on.
OccupancyCells free_map() {
  return {50, 50, 0.2, 0.0, 0.0, std::vector<CellState>(2500, CellState::kFree)};
}

void occupy(OccupancyCells& map, std::size_t column, std::size_t row) {
  map.state[row * map.columns + column] = CellState::kOccupied;
}

/// Along the row whose cells' centres are at y = 5.1 m.
const std::vector<WallSegment> kWall = {{{1.0, 5.1}, {9.0, 5.1}}};

OccupancyCells mapped_wall() {
  OccupancyCells map = free_map();
  for (std::size_t column = 5; column < 45; ++column) occupy(map, column, 25);
  return map;
}

TEST(MapQuality, OfAPerfectMapIsPerfect) {
  const MapQuality quality = map_quality(mapped_wall(), {}, {kWall, {}, {}, {}}, kToleranceM);
  EXPECT_EQ(quality.precision(), 1.0);
  EXPECT_EQ(quality.recall(), 1.0);
  EXPECT_EQ(quality.residue(), 0.0);
}

TEST(MapQuality, MissesAWallThatIsKnownToBeFreeAndIgnoresAnUnknownOne) {
  OccupancyCells map = free_map();
  EXPECT_EQ(map_quality(map, {}, {kWall, {}, {}, {}}, kToleranceM).recall(), 0.0);
  map.state.assign(map.state.size(), CellState::kUnknown);
  EXPECT_EQ(map_quality(map, {}, {kWall, {}, {}, {}}, kToleranceM).wall_samples, 0U);
}

TEST(MapQuality, AsksOnlyForWallsThatSentEchoesWhereTheseAreKnown) {
  OccupancyCells map = free_map();
  occupy(map, 10, 25);
  const MapQuality quality = map_quality(map, {}, {kWall, {}, {{2.1, 5.1}}, {}}, kToleranceM);
  EXPECT_GT(quality.wall_samples, 0U);
  EXPECT_LT(quality.wall_samples, 5U);
  EXPECT_EQ(quality.recall(), 1.0);
}

TEST(MapQuality, CallsItResidueWhereOnlyAMoverWas) {
  OccupancyCells map = mapped_wall();
  occupy(map, 10, 10);  // 2.1, 2.1
  occupy(map, 40, 40);  // 8.1, 8.1: nothing was ever there
  TrueObject walker = car_at(2.0, 2.0);
  walker.length_m = walker.width_m = 0.5;
  TrueObject along_the_wall = car_at(5.0, 5.1);
  const MapQuality quality =
      map_quality(map, {}, {kWall, {walker, along_the_wall}, {}, {}}, kToleranceM);
  EXPECT_EQ(quality.residue_cells, 1U);
  EXPECT_EQ(quality.occupied_cells - quality.right_cells, 2U);
}

TEST(MapQuality, BlamesAMoverOnlyForCellsFromWhichItSentAnEcho) {
  OccupancyCells map = free_map();
  occupy(map, 10, 10);  // 2.1, 2.1
  occupy(map, 20, 10);  // 4.1, 2.1
  TrueObject bus = car_at(3.0, 2.0);
  const MapQuality quality = map_quality(map, {}, {kWall, {bus}, {}, {{2.0, 2.0}}}, kToleranceM);
  EXPECT_EQ(quality.residue_cells, 1U);
}

TEST(MapQuality, MovesWithTheWorld) {
  const geometry::Pose2 world_from_map{100.0, -50.0, 1.2};
  const std::vector<WallSegment> wall = {
      {world_from_map * kWall[0].from_m, world_from_map * kWall[0].to_m}};
  const MapQuality quality =
      map_quality(mapped_wall(), world_from_map, {wall, {}, {}, {}}, kToleranceM);
  EXPECT_EQ(quality.precision(), 1.0);
  EXPECT_EQ(quality.recall(), 1.0);
}

}  // namespace
}  // namespace slammot::metrics
