#include "services/tracking/youth.hpp"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

namespace slammot::tracking {
namespace {

using Eigen::Matrix2d;
using Eigen::Vector2d;

const TrackingConfig kConfig;
constexpr std::int64_t kPeriodNs = 26'666'667;
constexpr double kSpeedMps = 6.0;

/// Two metres of the flank of a car that drives along y; something nearer hides the rest of it.
std::vector<Vector2d> flank_at(double time_s) {
  std::vector<Vector2d> points;
  for (double behind_m = 2.0; behind_m > -0.1; behind_m -= 0.2) points.emplace_back(20.0, kSpeedMps * time_s - behind_m);
  return points;
}

Glimpse glimpse_of(const std::vector<Vector2d>& points) {
  Glimpse glimpse;
  glimpse.points_m = points;
  glimpse.beam_step_rad = 0.5 * M_PI / 180.0;
  glimpse.start = Edge::kHidden;
  return glimpse;
}

/// As if the flank was the front of a car that comes nearer.
Track begun_as_a_front(int scans) {
  const std::vector<Vector2d> first = flank_at(0.0);
  Track track = begun({1}, 0, glimpse_of(first), 0.5 * M_PI, 1e-4 * Matrix2d::Identity(), kConfig);
  for (int i = 0; i < scans; ++i) {
    const std::vector<Vector2d> points = flank_at(static_cast<double>(i * kPeriodNs) * 1e-9);
    keep(track, i * kPeriodNs, glimpse_of(points), 1e-4 * Matrix2d::Identity());
  }
  return track;
}

TEST(Youth, TurnsABodyThatWentSideways) {
  Track track = begun_as_a_front(12);
  ASSERT_NEAR(std::abs(std::cos(track.body.heading_rad)), 1.0, 0.05);
  track = relive(track, kConfig);
  EXPECT_NEAR(std::abs(std::sin(track.body.heading_rad)), 1.0, 0.05);
  EXPECT_TRUE(track.body.is_oriented);
  EXPECT_LT((track.velocity_mps() - Vector2d(0.0, kSpeedMps)).norm(), 0.5);
  EXPECT_LT(track.position_m().y(), kSpeedMps * 11.0 * static_cast<double>(kPeriodNs) * 1e-9 - 1.5);  // behind the front that is seen
}

TEST(Youth, LeavesOpenWhichSideIsTheFlankOfWhatHasNotMoved) {
  Track track = begun_as_a_front(1);
  keep(track, kPeriodNs, glimpse_of(flank_at(0.0)), 1e-4 * Matrix2d::Identity());
  track = relive(track, kConfig);
  EXPECT_FALSE(track.body.is_oriented);
}

TEST(Youth, MovesWhereItBeganWithTheMiddle) {
  Track track = begun_as_a_front(12);
  const Vector2d way_m = track.position_m() - track.birth_position_m;
  track = relive(track, kConfig);
  EXPECT_LT((track.position_m() - track.birth_position_m - way_m).norm(), 1e-9);
}

TEST(Youth, IsForgottenButForItsEnd) {
  Track track = begun_as_a_front(100);
  EXPECT_EQ(track.youth.size(), 40U);
  EXPECT_EQ(track.youth.back().stamp_ns, 99 * kPeriodNs);
}

}  // namespace
}  // namespace slammot::tracking
