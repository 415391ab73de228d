#include "common/sensing/drop_outs.hpp"

#include <algorithm>
#include <random>

#include <gtest/gtest.h>

namespace slammot::sensing {
namespace {

constexpr float kNoEcho_m = 80.0F;

/// Along a wall, and for the last third into the open.
LaserScan half_open_scan(double drop_out_share) {
  std::mt19937 random(5);
  std::bernoulli_distribution drops(drop_out_share);
  LaserScan scan;
  scan.scanner.max_range_m = kNoEcho_m;
  for (int i = 0; i < 360; ++i)
    scan.range_m.push_back(i >= 240 || drops(random) ? kNoEcho_m : 6.0F + 0.01F * float(i));
  return scan;
}

std::vector<bool> drop_outs_of(const LaserScan& scan) {
  std::vector<bool> marks{true};  // of an earlier scan
  mark_drop_outs(scan, marks);
  return marks;
}

TEST(DropOuts, AreNotSeenInAScanThatHasNone) {
  const LaserScan scan = half_open_scan(0.0);
  EXPECT_EQ(shortest_free_run(scan), 1U);
  EXPECT_EQ(std::ranges::count(drop_outs_of(scan), true), 0);
}

TEST(DropOuts, AreLeftFreeWhereThereAreFew) {
  EXPECT_EQ(shortest_free_run(half_open_scan(0.03)), 1U);
}

TEST(DropOuts, AreToldFromTheOpen) {
  const LaserScan scan = half_open_scan(0.3);
  EXPECT_GE(shortest_free_run(scan), 3U);
  EXPECT_LE(shortest_free_run(scan), 5U);
  const std::vector<bool> marks = drop_outs_of(scan);
  ASSERT_EQ(marks.size(), scan.range_m.size());
  int of_wall = 0;
  int marked = 0;
  for (std::size_t i = 0; i < 240; ++i) {
    of_wall += scan.range_m[i] == kNoEcho_m;
    marked += marks[i];
    EXPECT_FALSE(marks[i] && scan.range_m[i] != kNoEcho_m) << "an echo";
  }
  EXPECT_GT(of_wall, 50);
  EXPECT_GE(marked, of_wall - 15) << "some runs of three beams or more may be left";
  for (std::size_t i = 245; i < 360; ++i) EXPECT_FALSE(marks[i]) << "the open, beam " << i;
}

TEST(DropOuts, AreOnlyToldByBeamsBetweenTwoOnOneSurface) {
  LaserScan scan = half_open_scan(0.0);
  for (std::size_t i = 1; i < 240; i += 2) {  // pickets before the open
    scan.range_m[i] = kNoEcho_m;
    scan.range_m[i - 1] = i % 4 == 1 ? 5.0F : 9.0F;
  }
  EXPECT_EQ(shortest_free_run(scan), 1U);
}

TEST(DropOuts, AreNotToldByAScanOfFewBeams) {
  LaserScan scan;
  scan.scanner.max_range_m = kNoEcho_m;
  scan.range_m = {5.0F, kNoEcho_m, 5.0F, kNoEcho_m, 5.0F};
  EXPECT_EQ(shortest_free_run(scan), 1U);
  scan.range_m.clear();
  EXPECT_TRUE(drop_outs_of(scan).empty());
}

TEST(DropOuts, LeaveALongRunFreeHoweverManyThereAre) {
  LaserScan scan = half_open_scan(0.95);
  EXPECT_LE(shortest_free_run(scan), 10U);
  EXPECT_FALSE(drop_outs_of(scan).back());
}

}  // namespace
}  // namespace slammot::sensing
