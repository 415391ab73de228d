#include "services/localization/local_map.hpp"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "tests/support/synthetic_world.hpp"

namespace slammot::localization {
namespace {

using flow::EndCell;
using geometry::Vector2;

constexpr double kBeamStep_rad = std::numbers::pi / 180.0;

LocalMapConfig small_config() {
  LocalMapConfig config;
  config.side_m = 60.0;
  return config;
}

std::vector<grids::Ray> rays_in(const slammot::testing::World& world, const Vector2& origin_m,
                                grids::Echo echo = grids::Echo::kStationary) {
  std::vector<grids::Ray> rays;
  for (int i = 0; i < 360; ++i) {
    const double range_m = slammot::testing::range_m(world, origin_m, i * kBeamStep_rad);
    rays.push_back(
        {origin_m + range_m * Vector2(std::cos(i * kBeamStep_rad), std::sin(i * kBeamStep_rad)),
         echo});
  }
  return rays;
}

LocalMap map_of_room(int scans = 10) {
  LocalMap map(small_config(), Vector2::Zero());
  for (int i = 0; i < scans; ++i)
    map.integrate(1000 + i, {0.1, 0.1}, rays_in(slammot::testing::room(), {0.1, 0.1}),
                  kBeamStep_rad);
  return map;
}

flow::LocalizedBeam expected_of(const LocalMap& map, const Vector2& end_m, bool has_echo = true) {
  flow::LocalizedBeam beam;
  beam.expected_range_m = map.expected_range_m({0.1, 0.1}, end_m, 50.0);
  if (has_echo) map.look_up_end(end_m, beam);
  return beam;
}

TEST(LocalMap, ExpectsAWallWhereItWasSeen) {
  const LocalMap map = map_of_room();
  const auto beam = expected_of(map, {0.1, -5.0});
  EXPECT_NEAR(beam.expected_range_m, 5.1, 0.25);
  EXPECT_EQ(beam.end_cell, EndCell::kOccupied);
}

TEST(LocalMap, ContradictsAnEchoFromFreeSpace) {
  const auto beam = expected_of(map_of_room(), {0.1, -3.0});
  EXPECT_EQ(beam.end_cell, EndCell::kFree);
  EXPECT_GT(beam.free_evidence, 0.8F);
  EXPECT_NEAR(beam.expected_range_m, 5.1, 0.25);
}

TEST(LocalMap, CannotSayWhatItHasNotSeen) {
  const auto beam = expected_of(map_of_room(), {0.1, -20.0});
  EXPECT_EQ(beam.end_cell, EndCell::kUnseen);
  EXPECT_EQ(beam.free_evidence, 0.0F);
}

TEST(LocalMap, NeedsMoreThanOneScanToBeSureOfFreeSpace) {
  EXPECT_EQ(expected_of(map_of_room(1), {0.1, -3.0}).end_cell, EndCell::kUnseen);
  EXPECT_EQ(expected_of(map_of_room(4), {0.1, -3.0}).end_cell, EndCell::kFree);
}

TEST(LocalMap, ExplainsAnEchoByAnOccupiedCellBesideIt) {
  const LocalMap map = map_of_room();
  EXPECT_EQ(expected_of(map, {0.1, -5.2}).end_cell, EndCell::kOccupied);
  EXPECT_EQ(expected_of(map, {0.1, -4.8}).end_cell, EndCell::kOccupied);
}

TEST(LocalMap, ExpectsNothingOfABeamWithoutEchoButItsRange) {
  const auto beam = expected_of(map_of_room(), {0.1, -49.9}, false);
  EXPECT_EQ(beam.end_cell, EndCell::kNoEcho);
  EXPECT_NEAR(beam.expected_range_m, 5.1, 0.25);
}

TEST(LocalMap, ExpectsTheWholeRangeOfAnEmptyMap) {
  const LocalMap map(small_config(), Vector2::Zero());
  EXPECT_EQ(expected_of(map, {0.1, -5.0}).expected_range_m, 50.0F);
  EXPECT_EQ(expected_of(map, {0.1, 0.1}).expected_range_m, 50.0F);  // an echo at the scanner itself
}

TEST(LocalMap, KeepsMovingEchoesOutOfTheStationaryMap) {
  LocalMap map(small_config(), Vector2::Zero());
  for (int i = 0; i < 10; ++i)
    map.integrate(i, {0.1, 0.1},
                  rays_in(slammot::testing::room(), {0.1, 0.1}, grids::Echo::kMoving),
                  kBeamStep_rad);
  const auto beam = expected_of(map, {0.1, -5.0});
  EXPECT_NE(beam.end_cell, EndCell::kOccupied);
  EXPECT_GT(beam.moving_evidence, 0.5F);
  EXPECT_TRUE(map.surfels().all().empty());
}

TEST(LocalMap, ForgetsTheSurfelsOfWhatHasGone) {
  LocalMap map = map_of_room(10);
  const auto without_wall = [](Vector2 end_m) { return end_m.y() < -4.9; };
  for (int i = 0; i < 60; ++i) {
    auto rays = rays_in(slammot::testing::room(), {0.1, 0.1});
    for (grids::Ray& ray : rays) {
      if (without_wall(ray.end_m)) ray = {1.5 * ray.end_m, grids::Echo::kNone};
    }
    map.integrate(2000 + i, {0.1, 0.1}, rays, kBeamStep_rad);
  }
  EXPECT_FALSE(map.surfels().nearest({0.1, -5.0}, 1));
  EXPECT_TRUE(map.surfels().nearest({0.1, 5.0}, 1));
}

TEST(LocalMap, TakesAPointBackAsStationary) {
  LocalMap map = map_of_room();
  for (int i = 0; i < 5; ++i) map.restore_stationary({0.1, -20.0});
  EXPECT_EQ(expected_of(map, {0.1, -20.0}).end_cell, EndCell::kOccupied);
  EXPECT_TRUE(map.surfels().nearest({0.1, -20.0}, 1));
}

TEST(LocalMap, IsOutgrownByDistanceOrByTravel) {
  const LocalMapConfig config = small_config();
  const LocalMap map(config, {3.0, 4.0});
  EXPECT_FALSE(map.is_outgrown({3.0, 4.0}, 0.0));
  EXPECT_FALSE(map.is_outgrown({3.0, 4.0}, config.new_map_after_travel_m - 1.0));
  EXPECT_TRUE(map.is_outgrown({3.0, 4.0}, config.new_map_after_travel_m));
  EXPECT_TRUE(map.is_outgrown({3.0 + config.new_map_after_m + 0.5, 4.0}, 0.0));
}

TEST(Submap, HoldsWhatWasSeenInItsOwnFrame) {
  LocalMapConfig config = small_config();
  config.surfel_size_m = config.cell_size_m;  // so that a surfel at a corner lies in a cell that
                                              // was hit
  LocalMap map(config, {20.0, -10.0});
  // Walls inside cells: one on a border belongs to this cell or that, by the last bit.
  const slammot::testing::World room =
      slammot::testing::moved(slammot::testing::room(15.7, 9.7), {20.0, -10.0, 0.0});
  for (int i = 0; i < 10; ++i)
    map.integrate(1000 + i, {20.1, -9.9}, rays_in(room, {20.1, -9.9}), kBeamStep_rad);
  const flow::Submap submap = map.submap();
  EXPECT_EQ(submap.first_stamp_ns, 1000);
  EXPECT_EQ(submap.last_stamp_ns, 1009);
  ASSERT_EQ(submap.so_log_odds.size(), std::size_t{submap.columns} * submap.rows);
  ASSERT_EQ(submap.mo_evidence.size(), submap.so_log_odds.size());
  EXPECT_NEAR(submap.columns * submap.cell_size_m, 16.0, 0.5);
  EXPECT_NEAR(submap.rows * submap.cell_size_m, 10.0, 0.5);
  ASSERT_GE(submap.surfels.size(), 0.9 * 50.8 / config.surfel_size_m);  // of 50.8 m of wall
  for (const flow::Surfel& surfel : submap.surfels) {
    const Vector2 in_odom_m = submap.odom_from_submap * Vector2(surfel.x_m, surfel.y_m);
    ASSERT_LT(std::abs(in_odom_m.x() - 20.0), 8.05);
    ASSERT_LT(std::abs(in_odom_m.y() + 10.0), 5.05);
    const auto column =
        static_cast<std::size_t>((surfel.x_m - submap.min_x_m) / submap.cell_size_m);
    const auto row = static_cast<std::size_t>((surfel.y_m - submap.min_y_m) / submap.cell_size_m);
    EXPECT_GT(submap.so_log_odds[row * submap.columns + column], 0);
  }
}

TEST(Submap, HoldsNothingOfTheOneBefore) {
  LocalMap map = map_of_room(20);
  map.begin_next({1.0, 1.0});
  EXPECT_EQ(map.submap_id(), flow::SubmapId{1});
  EXPECT_FALSE(map.has_echoes());
  const flow::Submap untouched = map.submap();
  EXPECT_EQ(untouched.columns, 0U);
  EXPECT_EQ(untouched.rows, 0U);
  EXPECT_TRUE(untouched.surfels.empty());
  // One beam more: only what this beam told is in the submap, though the map still knows the room.
  map.integrate(5000, {0.1, 0.1}, {{{0.1, -5.0}, grids::Echo::kStationary}}, kBeamStep_rad);
  const flow::Submap submap = map.submap();
  EXPECT_EQ(submap.first_stamp_ns, 5000);
  EXPECT_EQ(submap.surfels.size(), 1U);
  EXPECT_LE(submap.columns, 2U);
  EXPECT_EQ(expected_of(map, {8.0, 0.1}).end_cell, EndCell::kOccupied);
}

/// In steps, at a place in odom; 0 outside.
int so_log_odds_at(const flow::Submap& submap, const Vector2& in_odom_m) {
  const Vector2 at_m = geometry::inverse(submap.odom_from_submap) * in_odom_m;
  const int column =
      static_cast<int>(std::floor((at_m.x() - submap.min_x_m) / submap.cell_size_m + 1e-6));
  const int row =
      static_cast<int>(std::floor((at_m.y() - submap.min_y_m) / submap.cell_size_m + 1e-6));
  const bool is_inside = column >= 0 && row >= 0 && column < static_cast<int>(submap.columns) &&
                         row < static_cast<int>(submap.rows);
  return is_inside ? int{submap.so_log_odds[static_cast<std::size_t>(row) * submap.columns +
                                            static_cast<std::size_t>(column)]}
                   : 0;
}

TEST(Submap, SumsUpWithTheOnesBeforeToWhatTheMapKnows) {
  LocalMap map = map_of_room(3);
  const flow::Submap first = map.submap();
  map.begin_next({1.0, 1.0});
  for (int i = 0; i < 3; ++i)
    map.integrate(2000 + i, {-1.0, 0.3}, rays_in(slammot::testing::room(), {-1.0, 0.3}),
                  kBeamStep_rad);
  const flow::Submap second = map.submap();
  const grids::GridWindow& window = map.evidence().window();
  for (std::int32_t row = window.first.row; row < window.first.row + window.rows; ++row) {
    for (std::int32_t column = window.first.column; column < window.first.column + window.columns;
         ++column) {
      const Vector2 centre_m = window.centre_of({column, row});
      ASSERT_EQ(so_log_odds_at(first, centre_m) + so_log_odds_at(second, centre_m),
                map.evidence().lasting_cells()[window.index({column, row})]);
    }
  }
}

TEST(Submap, HasNothingStandingWhereABodyDroveInAnEarlierOne) {
  LocalMap map = map_of_room(1);
  for (int i = 0; i < 30; ++i) map.drive_over({{2.0, 0.0}, {1.0, 0.0}, {2.0, 1.0}});
  EXPECT_LT(so_log_odds_at(map.submap(), {2.1, 0.1}), 0);
  for (int submap = 0; submap < 2; ++submap) {
    map.begin_next({1.0, 1.0});
    for (int i = 0; i < 100; ++i)
      map.integrate(
          2000 + i, {0.1, 0.1},
          {{{2.1, 0.1}, grids::Echo::kStationary}, {{0.1, 2.1}, grids::Echo::kStationary}},
          kBeamStep_rad);
    EXPECT_LE(so_log_odds_at(map.submap(), {2.1, 0.1}), 0);
    EXPECT_GT(so_log_odds_at(map.submap(), {0.1, 2.1}), 0);
  }
}

TEST(Submap, LiesOnTheLatticeOfTheMap) {
  LocalMap map(small_config(), {3.33, -7.77});
  const auto on_lattice = [](double at_m) { return std::abs(std::remainder(at_m, 0.2)) < 1e-9; };
  map.integrate(1, {3.4, -7.7}, {{{5.0, -7.7}, grids::Echo::kStationary}}, kBeamStep_rad);
  const flow::Submap submap = map.submap();
  EXPECT_TRUE(on_lattice(submap.odom_from_submap.x_m + submap.min_x_m));
  EXPECT_TRUE(on_lattice(submap.odom_from_submap.y_m + submap.min_y_m));
}

}  // namespace
}  // namespace slammot::localization
