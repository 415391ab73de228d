#include "common/matching/pair_registration.hpp"

#include <algorithm>
#include <limits>
#include <numbers>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace slammot::matching {
namespace {

constexpr float kNoEcho = std::numeric_limits<float>::quiet_NaN();
const AssumedBeams kAllRound{.first_beam_rad = 0.0, .beam_step_rad = std::numbers::pi / 360.0};

/// 720 beams over all directions, of which the first ones have an echo.
std::vector<float> scan_with(std::size_t echoes, float range_m = 5.0F) {
  std::vector<float> ranges(720, kNoEcho);
  std::fill_n(ranges.begin(), echoes, range_m);
  return ranges;
}

TEST(PointsOf, AreAsManyAsWanted) {
  EXPECT_EQ(points_of(scan_with(720), kAllRound, 1.0, 90).size(), 90U);
}

TEST(PointsOf, AreHalfAsManyWhereFewBeamsHaveAnEcho) {
  const std::size_t points = points_of(scan_with(180), kAllRound, 1.0, 90).size();
  EXPECT_GE(points, 45U);
  EXPECT_LE(points, 90U);
}

TEST(PointsOf, AreAllEchoesWhereThereAreFewerThanWanted) {
  EXPECT_EQ(points_of(scan_with(50), kAllRound, 1.0, 360).size(), 50U);
}

TEST(PointsOf, LieWhereTheirBeamsLook) {
  std::vector<float> ranges = scan_with(0);
  ranges[180] = 3000.0F;
  const auto points = points_of(ranges, kAllRound, 1e-3, 720);
  ASSERT_THAT(points, ::testing::SizeIs(1));
  EXPECT_NEAR(points[0].x(), 0.0, 1e-5);
  EXPECT_NEAR(points[0].y(), 3.0, 1e-5);
}

TEST(PointsOf, AreNotBeyondThirtyMetres) {
  EXPECT_THAT(points_of(scan_with(720, 30.5F), kAllRound, 1.0, 90), ::testing::IsEmpty());
}

}  // namespace
}  // namespace slammot::matching
