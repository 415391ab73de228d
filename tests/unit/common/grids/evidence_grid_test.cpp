#include "common/grids/evidence_grid.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include "tests/support/synthetic_world.hpp"
#include "tests/unit/common/grids/slow_ray.hpp"

namespace slammot::grids {
namespace {

using Eigen::Vector2d;

constexpr double kCell_m = 0.25;  // a power of two: moving by whole cells is exact
const EvidenceModel kModel;
const int kHit = steps_of_log_odds(kModel.hit_log_odds);
const int kFree = steps_of_log_odds(kModel.free_log_odds);
const int kLimit = steps_of_log_odds(kModel.limit_log_odds);

EvidenceGrid empty_grid(double side_m = 20.0) {
  return {window_around({0.0, 0.0}, side_m, kCell_m), kModel};
}

template <class Visit>
void for_each_cell(const GridWindow& window, const Visit& visit) {
  for (std::int32_t row = window.first.row; row < window.first.row + window.rows; ++row) {
    for (std::int32_t column = window.first.column; column < window.first.column + window.columns;
         ++column)
      visit(Cell{column, row});
  }
}

/// A full turn of beams in a room, some without echo.
std::vector<Ray> rays_in_a_room(const Vector2d& origin_m, int beams,
                                const slammot::testing::World& world) {
  std::vector<Ray> rays;
  for (int i = 0; i < beams; ++i) {
    const double angle_rad = 2.0 * std::numbers::pi * i / beams;
    const double range_m = slammot::testing::range_m(world, origin_m, angle_rad);
    const Vector2d direction(std::cos(angle_rad), std::sin(angle_rad));
    if (i % 7 == 0) {
      rays.push_back({origin_m + 3.0 * direction, Echo::kNone});
    } else {
      rays.push_back(
          {origin_m + range_m * direction, i % 11 == 0 ? Echo::kMoving : Echo::kStationary});
    }
  }
  return rays;
}

std::vector<Ray> rays_in_a_room(const Vector2d& origin_m, int beams) {
  // walls inside cells, not between
  return rays_in_a_room(origin_m, beams, slammot::testing::room(15.7, 10.3));
}

std::vector<Ray> shifted(std::vector<Ray> rays, const Vector2d& by_m) {
  for (Ray& ray : rays) ray.end_m += by_m;
  return rays;
}

/// What a single scan does to an empty grid, cell by cell and ray by ray. Cells that a ray only
/// touches are undecided.
enum class Expected { kUntouched, kFree, kOccupied, kMoved, kUndecided };

Expected expected_of(Cell cell, const Vector2d& origin_m, const std::vector<Ray>& rays) {
  constexpr double kGraze_m = 2e-6;
  const GridWindow lattice{.cell_size_m = kCell_m};
  for (const Ray& ray : rays) {
    if (ray.echo == Echo::kNone || lattice.cell_at(ray.end_m.x(), ray.end_m.y()) != cell) continue;
    return ray.echo == Echo::kStationary ? Expected::kOccupied : Expected::kMoved;
  }
  Expected expected = Expected::kUntouched;
  for (const Ray& ray : rays) {
    const double length_m = (ray.end_m - origin_m).norm();
    const double free_m = ray.echo == Echo::kNone ? length_m : length_m - 1.5 * kCell_m;
    const auto passage =
        passage_through(cell, kCell_m, origin_m, (ray.end_m - origin_m) / length_m);
    if (!passage || passage->in_m > free_m + kGraze_m) continue;
    if (passage->in_m < free_m - kGraze_m && passage->length_m() > kGraze_m) return Expected::kFree;
    expected = Expected::kUndecided;
  }
  return expected;
}

TEST(EvidenceGrid, MarksWhatASlowRayCasterMarks) {
  for (const Vector2d& origin_m : {Vector2d(0.1, 0.2), {-5.03, 3.3}, {7.0, -4.9}}) {
    EvidenceGrid grid = empty_grid();
    const auto rays = rays_in_a_room(origin_m, 97);
    grid.integrate(origin_m, rays, 0.0);
    for_each_cell(grid.window(), [&](Cell cell) {
      switch (expected_of(cell, origin_m, rays)) {
        case Expected::kUntouched: ASSERT_EQ(grid.so_steps(cell), 0); break;
        case Expected::kFree: ASSERT_EQ(grid.so_steps(cell), -kFree); break;
        case Expected::kOccupied: ASSERT_EQ(grid.so_steps(cell), kHit); break;
        case Expected::kMoved: ASSERT_GT(grid.moving(cell), 0); break;
        case Expected::kUndecided: break;
      }
    });
  }
}

TEST(EvidenceGrid, FillsBetweenBeamsWhatEachBeamByItselfWouldMark) {
  const Vector2d origin_m(0.1, 0.2);
  constexpr int kBeams = 720;
  const auto world = slammot::testing::box({}, 15.7, 10.3);  // nothing in it: beams beside a pillar
                                                             // tell less of its shadow
  std::vector<Ray> rays;
  for (int i = 0; i < kBeams; ++i) {
    const double angle_rad = 2.0 * std::numbers::pi * i / kBeams;
    const double range_m = slammot::testing::range_m(world, origin_m, angle_rad);
    rays.push_back({origin_m + range_m * Vector2d(std::cos(angle_rad), std::sin(angle_rad)),
                    Echo::kStationary});
  }
  EvidenceGrid all_of_each_beam = empty_grid();
  all_of_each_beam.integrate(origin_m, rays, 0.0);
  EvidenceGrid grid = empty_grid();
  grid.integrate(origin_m, rays, 2.0 * std::numbers::pi / kBeams);
  int free_cells = 0;
  int lost_cells = 0;
  for_each_cell(grid.window(), [&](Cell cell) {
    if (all_of_each_beam.so_steps(cell) >= 0) {
      EXPECT_EQ(grid.so_steps(cell), all_of_each_beam.so_steps(cell));
      return;
    }
    ++free_cells;
    if (grid.so_steps(cell) != 0) return;
    ++lost_cells;  // at the rim: here a cell counts by its centre, there when it is touched
    const Vector2d way_m = grid.window().centre_of(cell) - origin_m;
    EXPECT_GT(way_m.norm(),
              slammot::testing::range_m(world, origin_m, std::atan2(way_m.y(), way_m.x())) -
                  2.2 * kCell_m);
  });
  EXPECT_GT(free_cells, 1000);
  EXPECT_LT(lost_cells, free_cells / 10);
}

/// Two beams side by side, to the east, that end at these ranges.
EvidenceGrid grid_after_two_beams(double first_m, double second_m, double beam_step_rad) {
  EvidenceGrid grid = empty_grid(40.0);
  std::vector<Ray> rays;
  for (const double angle_rad : {-0.5 * beam_step_rad, 0.5 * beam_step_rad}) {
    const double range_m = rays.empty() ? first_m : second_m;
    rays.push_back(
        {Vector2d(0.1, 0.1) + range_m * Vector2d(std::cos(angle_rad), std::sin(angle_rad)),
         Echo::kStationary});
  }
  grid.integrate({0.1, 0.1}, rays, beam_step_rad);
  return grid;
}

int free_at(const EvidenceGrid& grid, double range_m) {
  return grid.so_steps(grid.window().cell_at(0.1 + range_m, 0.1));
}

TEST(EvidenceGrid, HoldsWhatLiesBeforeASurfaceForFreeAsFarAsTheShorterBeamGoes) {
  const EvidenceGrid grid = grid_after_two_beams(10.0, 13.0, 0.045);  // a wall at a flat angle
  const auto beside = [&](double range_m) {
    return grid.so_steps(
        grid.window().cell_at(0.1 + range_m * std::cos(0.012), 0.1 + range_m * std::sin(0.012)));
  };
  EXPECT_EQ(free_at(grid, 9.0), -kFree);
  EXPECT_EQ(beside(9.0), -kFree);
  EXPECT_EQ(beside(11.5), 0);  // nearer to the longer beam
}

TEST(EvidenceGrid, TellsOfTheSpaceBeforeWhatIsTooFarToBeMapped) {
  EvidenceGrid grid = empty_grid(40.0);
  grid.integrate({0.1, 0.1}, {{{10.1, 0.1}, Echo::kTooFar}}, 0.0);
  EXPECT_EQ(free_at(grid, 9.0), -kFree);
  EXPECT_EQ(free_at(grid, 9.9), 0);  // there it ends
  EXPECT_EQ(free_at(grid, 10.0), 0);
  EXPECT_EQ(grid.moving(grid.window().cell_at(10.1, 0.1)), 0);
}

TEST(EvidenceGrid, LetsTheBeamsOfTwoThingsStandForHalfOfWhatLiesBetween) {
  const EvidenceGrid grid = grid_after_two_beams(10.0, 17.0, 0.045);  // 0.45 m apart where the
                                                                      // first one ends
  const auto beside = [&](double range_m, double angle_rad) {
    return grid.so_steps(grid.window().cell_at(0.1 + range_m * std::cos(angle_rad),
                                               0.1 + range_m * std::sin(angle_rad)));
  };
  EXPECT_EQ(beside(8.0, -0.012), -kFree);
  EXPECT_EQ(beside(14.0, -0.012), 0);
  EXPECT_EQ(beside(14.0, 0.012), -kFree);
}

TEST(EvidenceGrid, SaysNothingBetweenBeamsThatAreFarApart) {
  const EvidenceGrid grid = grid_after_two_beams(18.0, 18.0, 0.09);
  EXPECT_EQ(free_at(grid, 5.0), -kFree);
  EXPECT_EQ(free_at(grid, 15.0), 0);  // 1.35 m between them: room for a post
  EXPECT_EQ(grid.so_steps(
                grid.window().cell_at(0.1 + 15.0 * std::cos(0.045), 0.1 + 15.0 * std::sin(0.045))),
            -kFree);  // on the beam itself
}

TEST(EvidenceGrid, ChangesACellOnceAScanHoweverManyBeamsMeetThere) {
  EvidenceGrid grid = empty_grid();
  grid.integrate({0.1, 0.1}, std::vector<Ray>(50, {{5.1, 0.1}, Echo::kStationary}), 0.0);
  EXPECT_EQ(grid.so_steps({20, 0}), kHit);
  EXPECT_EQ(grid.so_steps({10, 0}), -kFree);
}

TEST(EvidenceGrid, LetsAnEchoWinOverABeamThatPassed) {
  for (const bool echo_first : {true, false}) {
    std::vector<Ray> rays = {{{5.1, 0.1}, Echo::kStationary}, {{9.0, 0.1}, Echo::kStationary}};
    if (!echo_first) std::swap(rays[0], rays[1]);
    EvidenceGrid grid = empty_grid();
    grid.integrate({0.1, 0.1}, rays, 0.0);
    EXPECT_EQ(grid.so_steps({20, 0}), kHit);
  }
}

TEST(EvidenceGrid, IsNeverSurerThanItsLimit) {
  EvidenceGrid grid = empty_grid();
  for (int i = 0; i < 300; ++i) grid.integrate({0.1, 0.1}, {{{5.1, 0.1}, Echo::kStationary}}, 0.0);
  EXPECT_EQ(grid.so_steps({20, 0}), kLimit);
  EXPECT_EQ(grid.so_steps({10, 0}), -kLimit);
}

TEST(EvidenceGrid, ForgetsAWallThatIsGone) {
  EvidenceGrid grid = empty_grid();
  for (int i = 0; i < 50; ++i) grid.integrate({0.1, 0.1}, {{{5.1, 0.1}, Echo::kStationary}}, 0.0);
  for (int i = 0; i < 50; ++i) grid.integrate({0.1, 0.1}, {{{9.1, 0.1}, Echo::kStationary}}, 0.0);
  EXPECT_EQ(grid.so_steps({20, 0}), -kLimit);
  EXPECT_NEAR(grid.distance_to_occupied({0.1, 0.1}, {1.0, 0.0}, 15.0), 9.0 - 0.1, 1e-9);
}

TEST(EvidenceGrid, GathersMovingEvidenceWithoutOccupyingTheCell) {
  EvidenceGrid grid = empty_grid();
  int before = 0;
  for (int i = 0; i < 40; ++i) {
    grid.integrate({0.1, 0.1}, {{{5.1, 0.1}, Echo::kMoving}}, 0.0);
    EXPECT_TRUE(grid.moving({20, 0}) > before || before == 255);
    before = grid.moving({20, 0});
  }
  EXPECT_EQ(before, 255);
  EXPECT_EQ(grid.so_steps({20, 0}), 0);
  EXPECT_EQ(grid.so_steps({10, 0}), -kLimit);
}

TEST(EvidenceGrid, SeesNoDifferenceBetweenTheFirstScanAndTheThreeHundredth) {
  // The mark of a scan is one byte: cells last seen 255 scans ago must not look as if they had been
  // seen in this one.
  for (const int scans_between : {253, 254, 255, 256, 510}) {
    EvidenceGrid grid = empty_grid();
    const std::vector<Ray> east = {{{5.1, 0.1}, Echo::kStationary}};
    const std::vector<Ray> north = {{{0.1, 5.1}, Echo::kStationary}};
    grid.integrate({0.1, 0.1}, east, 0.0);
    for (int i = 0; i < scans_between; ++i) grid.integrate({0.1, 0.1}, north, 0.0);
    grid.integrate({0.1, 0.1}, east, 0.0);
    EXPECT_EQ(grid.so_steps({20, 0}), 2 * kHit) << scans_between;
    EXPECT_EQ(grid.so_steps({10, 0}), -2 * kFree) << scans_between;
  }
}

void expect_same_cells(const EvidenceGrid& a, const EvidenceGrid& b) {
  EXPECT_EQ(a.so_cells(), b.so_cells());
  EXPECT_EQ(a.mo_cells(), b.mo_cells());
  EXPECT_EQ(a.lasting_cells(), b.lasting_cells());
}

TEST(EvidenceGrid, HoldsTheSameWhetherAScanWasPreparedOrNotAndWhateverMoved) {
  constexpr int kBeams = 361;
  const double step_rad = 2.0 * std::numbers::pi / kBeams;
  EvidenceGrid prepared = empty_grid();
  EvidenceGrid at_once = empty_grid();
  for (int scan = 0; scan < 10; ++scan) {
    const Vector2d origin_m(0.1 + 0.2 * scan, 0.3);
    std::vector<Ray> rays = rays_in_a_room(origin_m, kBeams);
    prepared.prepare(origin_m, rays, step_rad);
    for (std::size_t i = 0; i < rays.size(); i += 5) {
      if (rays[i].echo != Echo::kNone)
        rays[i].echo = rays[i].echo == Echo::kMoving ? Echo::kStationary : Echo::kMoving;
    }
    prepared.integrate(origin_m, rays, step_rad);
    at_once.integrate(origin_m, rays, step_rad);
    expect_same_cells(prepared, at_once);
  }
}

TEST(EvidenceGrid, BeginsAnewWhereAnotherScanWasPrepared) {
  constexpr int kBeams = 361;
  const double step_rad = 2.0 * std::numbers::pi / kBeams;
  const Vector2d origin_m(0.1, 0.3);
  const std::vector<Ray> rays = rays_in_a_room(origin_m, kBeams);
  std::vector<Ray> fewer_echoes = rays;
  for (std::size_t i = 3; i < rays.size(); i += 9) fewer_echoes[i].echo = Echo::kNone;
  const Vector2d elsewhere_m(-1.3, 0.7);
  const std::vector<Ray> rays_from_elsewhere = rays_in_a_room(elsewhere_m, kBeams);
  EvidenceGrid at_once = empty_grid();
  at_once.integrate(origin_m, fewer_echoes, step_rad);
  at_once.integrate(origin_m, rays, step_rad);
  EvidenceGrid prepared = empty_grid();
  prepared.prepare(origin_m, rays, step_rad);
  prepared.integrate(origin_m, fewer_echoes, step_rad);
  prepared.prepare(elsewhere_m, rays_from_elsewhere, step_rad);
  prepared.prepare(origin_m, rays, 0.5 * step_rad);
  prepared.integrate(origin_m, rays, step_rad);
  expect_same_cells(prepared, at_once);
}

TEST(EvidenceGrid, CutsRaysAtItsBorder) {
  EvidenceGrid grid = empty_grid(4.0);
  std::vector<Ray> rays;
  for (int i = 0; i < 360; ++i) {
    const double angle_rad = i * std::numbers::pi / 180.0;
    rays.push_back({100.0 * Vector2d(std::cos(angle_rad), std::sin(angle_rad)), Echo::kStationary});
  }
  grid.integrate({0.1, 0.1}, rays, 0.0);
  int untouched = 0;
  for_each_cell(grid.window(), [&](Cell cell) { untouched += grid.so_steps(cell) != -kFree; });
  EXPECT_EQ(untouched, 0);
  EXPECT_EQ(grid.so_steps({1000, 0}), 0);
}

TEST(EvidenceGrid, TakesTheEchoesOfAScannerOutsideButNotItsBeams) {
  EvidenceGrid grid = empty_grid(4.0);
  grid.integrate({-50.0, 0.1}, {{{1.1, 0.1}, Echo::kStationary}}, 0.0);
  EXPECT_EQ(grid.so_steps({4, 0}), kHit);
  EXPECT_EQ(grid.so_steps({0, 0}), 0);
}

TEST(EvidenceGrid, TakesABeamThatEndsAtTheScanner) {
  EvidenceGrid grid = empty_grid(4.0);
  grid.integrate({0.1, 0.1}, {{{0.1, 0.1}, Echo::kNone}, {{0.1, 0.1}, Echo::kStationary}}, 0.01);
  EXPECT_EQ(grid.so_steps({0, 0}), kHit);
}

TEST(EvidenceGrid, GivesBackAPointAsAnEcho) {
  EvidenceGrid grid = empty_grid();
  grid.integrate({0.1, 0.1}, {{{5.1, 0.1}, Echo::kNone}}, 0.0);
  const int before = grid.so_steps({10, 0});
  grid.restore_stationary({2.6, 0.1});
  EXPECT_EQ(grid.so_steps({10, 0}), before + kHit);
  grid.restore_stationary({1e6, 0.0});  // outside: nothing happens
}

TEST(EvidenceGrid, TakesFromWhatIsOccupiedUnderABoxAsMuchAsABeamThatPasses) {
  EvidenceGrid grid = empty_grid();
  std::vector<Vector2d> echoes_m;
  for (double along = -4.0; along <= 4.0; along += 0.5)
    for (double across = -2.0; across <= 2.0; across += 0.5) echoes_m.push_back({along, across});
  for (const Vector2d& echo_m : echoes_m) grid.restore_stationary(echo_m);
  const EvidenceGrid before = grid;
  constexpr double kHeadingRad = 0.6;
  const Box box{{0.5, -0.5}, {std::cos(kHeadingRad), std::sin(kHeadingRad)}, {2.0, 0.9}};
  grid.drive_over(box);
  int changed = 0;
  for_each_cell(grid.window(), [&](Cell cell) {
    const Vector2d from_centre_m =
        Eigen::Rotation2Dd(-kHeadingRad) * (grid.window().centre_of(cell) - box.centre_m);
    const bool is_inside = std::abs(from_centre_m.x()) <= box.half_m.x() &&
                           std::abs(from_centre_m.y()) <= box.half_m.y();
    const bool is_taken_from = is_inside && before.so_steps(cell) > 0;
    ASSERT_EQ(grid.so_steps(cell), before.so_steps(cell) - (is_taken_from ? kFree : 0))
        << cell.column << " " << cell.row;
    changed += is_taken_from ? 1 : 0;
  });
  EXPECT_GT(changed, 20);
  for (const Box& elsewhere :
       {Box{{1e6, 0.0}, {1.0, 0.0}, {2.0, 1.0}}, Box{{0.0, -1e6}, {0.0, 1.0}, {2.0, 1.0}},
        Box{{1e300, -1e300}, {1.0, 0.0}, {2.0, 1.0}}})
    grid.drive_over(elsewhere);
  grid.drive_over({{9.9, 9.9}, {0.6, 0.8}, {30.0, 0.1}});  // partly outside
  const int before_all = grid.so_steps({0, 0});
  grid.drive_over({{0.0, 0.0}, {1.0, 0.0}, {1e300, 1e300}});
  EXPECT_EQ(grid.so_steps({0, 0}), before_all - kFree);
}

/// Beams to the east, side by side, that end at these ranges.
EvidenceGrid grid_after_a_fan(const std::vector<double>& ranges_m, double beam_step_rad,
                              Echo outer_echo = Echo::kStationary) {
  EvidenceGrid grid = empty_grid(160.0);
  std::vector<Ray> rays;
  for (std::size_t i = 0; i < ranges_m.size(); ++i) {
    const double angle_rad =
        beam_step_rad * (static_cast<double>(i) - 0.5 * static_cast<double>(ranges_m.size() - 1));
    const bool is_outer = i == 0 || i + 1 == ranges_m.size();
    rays.push_back(
        {Vector2d(0.1, 0.1) + ranges_m[i] * Vector2d(std::cos(angle_rad), std::sin(angle_rad)),
         is_outer ? outer_echo : Echo::kStationary});
  }
  grid.integrate({0.1, 0.1}, rays, beam_step_rad);
  return grid;
}

int lasting_steps(const EvidenceGrid& grid, const Vector2d& at_m) {
  return grid.lasting_cells()[grid.window().index(grid.window().cell_at(at_m.x(), at_m.y()))];
}

int so_steps(const EvidenceGrid& grid, const Vector2d& at_m) {
  return grid.so_steps(grid.window().cell_at(at_m.x(), at_m.y()));
}

TEST(EvidenceGridThatLasts, IsFreeAsFarAsTheBeamsBesideGo) {
  const EvidenceGrid grid = grid_after_a_fan({12.0, 30.0, 30.0}, 0.01);
  EXPECT_LT(lasting_steps(grid, {10.1, 0.1}), 0);
  EXPECT_EQ(lasting_steps(grid, {15.1, 0.1}), 0);  // beside what ended the beam there
  EXPECT_LT(so_steps(grid, {15.1, 0.1}), 0);
  EXPECT_GT(lasting_steps(grid, {30.1, 0.1}), 0);
}

TEST(EvidenceGridThatLasts, IsFreeBesideABeamThatNothingEnded) {
  EXPECT_LT(lasting_steps(grid_after_a_fan({12.0, 30.0, 12.0}, 0.01, Echo::kNone), {15.1, 0.1}), 0);
  EXPECT_EQ(lasting_steps(grid_after_a_fan({12.0, 30.0, 12.0}, 0.01, Echo::kTooFar), {15.1, 0.1}),
            0);
}

TEST(EvidenceGridThatLasts, IsFreeBetweenBeamsThatAreFarApart) {
  const EvidenceGrid grid = grid_after_a_fan({70.0, 70.0, 70.0}, 0.04);
  EXPECT_LT(lasting_steps(grid, {60.1, 0.9}), 0);
  EXPECT_EQ(so_steps(grid, {60.1, 0.9}), 0);
}

TEST(EvidenceGridThatLasts, SaysNothingOfTheLastBeamsToEitherSide) {
  const EvidenceGrid grid = grid_after_a_fan({30.0, 30.0}, 0.01);
  EXPECT_TRUE(
      std::ranges::none_of(grid.lasting_cells(), [](std::int8_t steps) { return steps < 0; }));
}

TEST(EvidenceGridThatLasts, TakesBackOnlyWhatWasKeptOutOfIt) {
  EvidenceGrid grid = empty_grid();
  grid.restore_stationary({2.6, 0.1}, Echo::kStationary);
  EXPECT_EQ(lasting_steps(grid, {2.6, 0.1}), 0);
  EXPECT_EQ(so_steps(grid, {2.6, 0.1}), kHit);
  grid.restore_stationary({2.6, 0.1}, Echo::kMoving);
  EXPECT_GT(lasting_steps(grid, {2.6, 0.1}), 0);
}

TEST(EvidenceGridThatLasts, RemembersWhereABodyDrove) {
  EvidenceGrid grid = empty_grid();
  for (int scan = 0; scan < 30; ++scan) grid.drive_over({{0.0, 0.0}, {1.0, 0.0}, {2.0, 1.0}});
  for (int scan = 0; scan < 300; ++scan) grid.restore_stationary({0.1, 0.1});
  EXPECT_LT(lasting_steps(grid, {0.1, 0.1}), 0);
  EXPECT_GT(so_steps(grid, {0.1, 0.1}), 0);
}

TEST(EvidenceGrid, MovesWithTheWorld) {
  const Vector2d by_m(37 * kCell_m, -91 * kCell_m);
  const Vector2d origin_m(0.125, 0.25);
  const auto rays = rays_in_a_room(origin_m, 181);
  EvidenceGrid here = empty_grid();
  here.integrate(origin_m, rays, 0.0);
  EvidenceGrid there(window_around(by_m, 20.0, kCell_m), kModel);
  there.integrate(origin_m + by_m, shifted(rays, by_m), 0.0);
  int differences = 0;
  for_each_cell(here.window(), [&](Cell cell) {
    differences += here.so_steps(cell) != there.so_steps({cell.column + 37, cell.row - 91});
  });
  EXPECT_LE(differences, 4);  // cells that a ray only grazes
}

TEST(EvidenceGrid, MovedToAnotherWindowGoesOnAsIfItHadAlwaysBeenThere) {
  // Wide apart beams, so that many cells seen in one scan are not seen in the next.
  const GridWindow next_window = window_around({3.0, -2.0}, 24.0, kCell_m);
  for (const int scans_before : {1, 2, 7, 254, 255, 256}) {
    EvidenceGrid moved_last = empty_grid(40.0);
    for (int i = 0; i < scans_before; ++i)
      moved_last.integrate({0.1, 0.1}, rays_in_a_room({0.1, 0.1}, 31 + i % 3), 0.0);
    EvidenceGrid moved_first = moved_last.moved_to(next_window);
    for (int i = 0; i < 5; ++i) {
      const Vector2d origin_m(0.4 + 0.1 * i, -0.3);
      moved_last.integrate(origin_m, rays_in_a_room(origin_m, 37), 0.0);
      moved_first.integrate(origin_m, rays_in_a_room(origin_m, 37), 0.0);
    }
    EXPECT_EQ(moved_first.so_cells(), moved_last.moved_to(next_window).so_cells()) << scans_before;
    EXPECT_EQ(moved_first.mo_cells(), moved_last.moved_to(next_window).mo_cells()) << scans_before;
    EXPECT_EQ(moved_first.lasting_cells(), moved_last.moved_to(next_window).lasting_cells())
        << scans_before;
  }
}

TEST(EvidenceGrid, IsWhatItsCellsAre) {
  EvidenceGrid grid = empty_grid();
  for (int i = 0; i < 20; ++i) grid.integrate({0.1, 0.1}, rays_in_a_room({0.1, 0.1}, 180), 0.0);
  EvidenceGrid copy = empty_grid();
  copy.set_cells(grid.so_cells(), grid.mo_cells(), grid.lasting_cells());
  EXPECT_EQ(copy.so_cells(), grid.so_cells());
  EXPECT_EQ(copy.lasting_cells(), grid.lasting_cells());
  for (int i = 0; i < 360; ++i) {
    const Vector2d direction(std::cos(i), std::sin(i));
    EXPECT_EQ(copy.distance_to_occupied({0.4, 0.3}, direction, 30.0),
              grid.distance_to_occupied({0.4, 0.3}, direction, 30.0));
  }
}

TEST(HighestSoSteps, LooksAtTheWholeSquare) {
  EvidenceGrid grid = empty_grid();
  grid.integrate({0.1, 0.1}, {{{5.1, 0.1}, Echo::kStationary}}, 0.0);
  EXPECT_EQ(grid.highest_so_steps({18, 2}, 2), kHit);
  EXPECT_EQ(grid.highest_so_steps({17, 2}, 2), 0);
  EXPECT_EQ(grid.highest_so_steps({10, 0}, 0), -kFree);
  EXPECT_TRUE(grid.is_occupied_near({18, 2}, 2));
  EXPECT_FALSE(grid.is_occupied_near({17, 2}, 2));
}

/// The nearest occupied cell on the ray, found by cutting the ray with every occupied cell.
double slow_distance_m(const EvidenceGrid& grid, const Vector2d& origin_m,
                       const Vector2d& direction, double max_range_m) {
  double nearest_m = max_range_m;
  for_each_cell(grid.window(), [&](Cell cell) {
    if (!grid.is_occupied_near(cell, 0)) return;
    const auto passage = passage_through(cell, kCell_m, origin_m, direction);
    if (passage && passage->length_m() > 1e-5) nearest_m = std::min(nearest_m, passage->in_m);
  });
  return nearest_m;
}

TEST(DistanceToOccupied, IsWhatASlowRayCasterMeasures) {
  std::mt19937 random(9);
  std::uniform_real_distribution<double> place(-10.0, 10.0);
  std::uniform_real_distribution<double> angle(-std::numbers::pi, std::numbers::pi);
  EvidenceGrid grid = empty_grid();
  for (int i = 0; i < 150; ++i) grid.restore_stationary({place(random), place(random)});
  grid.integrate({0.0, 0.0}, rays_in_a_room({0.0, 0.0}, 60), 0.0);  // and some of it seen to be
                                                                    // free again
  for (int i = 0; i < 2000; ++i) {
    const Vector2d origin_m(place(random), place(random));
    const double angle_rad = angle(random);
    const Vector2d direction(std::cos(angle_rad), std::sin(angle_rad));
    const double max_range_m = 2.0 + std::abs(place(random));
    ASSERT_NEAR(grid.distance_to_occupied(origin_m, direction, max_range_m),
                slow_distance_m(grid, origin_m, direction, max_range_m), 2e-5);
  }
}

TEST(DistanceToOccupied, FindsTheFewThingsOfAWideMapFromEverywhere) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> place(-119.0, 119.0);
  std::uniform_real_distribution<double> angle(-std::numbers::pi, std::numbers::pi);
  EvidenceGrid grid(window_around({0.0, 0.0}, 240.0, kCell_m), EvidenceModel{});
  std::vector<Cell> occupied;
  for (int i = 0; i < 400; ++i) {
    const Vector2d at_m(place(random), place(random));
    grid.restore_stationary(at_m);
    occupied.push_back(grid.window().cell_at(at_m.x(), at_m.y()));
  }
  for (int i = 0; i < 5000; ++i) {
    const Vector2d origin_m(place(random), place(random));
    const double angle_rad = i % 4 == 0
                                 ? 0.5 * std::numbers::pi * (i % 16 / 4) + 1e-3 * angle(random)
                                 : angle(random);  // also nearly along an axis
    const Vector2d direction(std::cos(angle_rad), std::sin(angle_rad));
    double nearest_m = 300.0;
    for (const Cell cell : occupied) {
      const auto passage = passage_through(cell, kCell_m, origin_m, direction);
      if (passage && passage->length_m() > 1e-5) nearest_m = std::min(nearest_m, passage->in_m);
    }
    ASSERT_NEAR(grid.distance_to_occupied(origin_m, direction, 300.0), nearest_m, 2e-5)
        << origin_m.transpose() << " " << angle_rad;
  }
}

TEST(DistanceToOccupied, IsTheWholeRangeWhereNothingStands) {
  EXPECT_EQ(empty_grid().distance_to_occupied({0.1, 0.1}, {0.6, 0.8}, 7.5), 7.5);
  EXPECT_EQ(empty_grid().distance_to_occupied({0.1, 0.1}, {0.6, 0.8}, 1e4), 1e4);
  EXPECT_EQ(empty_grid().distance_to_occupied({1e4, 0.1}, {0.6, 0.8}, 50.0), 50.0);
}

TEST(DistanceToOccupied, IsNothingInsideAnOccupiedCell) {
  EvidenceGrid grid = empty_grid();
  grid.restore_stationary({0.1, 0.1});
  EXPECT_NEAR(grid.distance_to_occupied({0.12, 0.1}, {1.0, 0.0}, 10.0), 0.0, 1e-5);
}

TEST(DistanceToOccupied, WorksOnAxisParallelRays) {
  EvidenceGrid grid = empty_grid();
  for (const Vector2d& wall_m : {Vector2d(5.1, 0.1), {-5.1, 0.1}, {0.1, 5.1}, {0.1, -5.1}})
    grid.restore_stationary(wall_m);
  EXPECT_NEAR(grid.distance_to_occupied({0.1, 0.1}, {1.0, 0.0}, 10.0), 4.9, 1e-5);
  EXPECT_NEAR(grid.distance_to_occupied({0.1, 0.1}, {-1.0, 0.0}, 10.0), 5.1, 1e-5);
  EXPECT_NEAR(grid.distance_to_occupied({0.1, 0.1}, {0.0, 1.0}, 10.0), 4.9, 1e-5);
  EXPECT_NEAR(grid.distance_to_occupied({0.1, 0.1}, {0.0, -1.0}, 10.0), 5.1, 1e-5);
}

TEST(StepsOfLogOdds, RoundsToTheNearestStep) {
  EXPECT_EQ(steps_of_log_odds(0.0), 0);
  EXPECT_EQ(steps_of_log_odds(1.0), 16);
  EXPECT_EQ(steps_of_log_odds(-0.5), -8);
  EXPECT_EQ(steps_of_log_odds(0.30), 5);
}

}  // namespace
}  // namespace slammot::grids
