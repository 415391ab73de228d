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
    track.youth.add(i * kPeriodNs, glimpse_of(points), 1e-4 * Matrix2d::Identity());
  }
  return track;
}

TEST(Youth, TurnsABodyThatWentSideways) {
  Track track = begun_as_a_front(12);
  ASSERT_NEAR(std::abs(std::cos(track.body.heading_rad)), 1.0, 0.05);
  live_as(track, relived(track, kConfig));
  EXPECT_NEAR(std::abs(std::sin(track.body.heading_rad)), 1.0, 0.05);
  EXPECT_TRUE(track.body.is_oriented);
  EXPECT_LT((track.velocity_mps() - Vector2d(0.0, kSpeedMps)).norm(), 0.5);
  EXPECT_LT(track.position_m().y(), kSpeedMps * 11.0 * static_cast<double>(kPeriodNs) * 1e-9 - 1.5);  // behind the front that is seen
}

TEST(Youth, LeavesOpenWhichSideIsTheFlankOfWhatHasNotMoved) {
  Track track = begun_as_a_front(1);
  track.youth.add(kPeriodNs, glimpse_of(flank_at(0.0)), 1e-4 * Matrix2d::Identity());
  live_as(track, relived(track, kConfig));
  EXPECT_FALSE(track.body.is_oriented);
}

TEST(Youth, IsNotFastBecauseItsOtherEndComesIntoView) {
  constexpr int kScans = 24;
  Track track;
  for (int i = 0; i < kScans; ++i) {  // a bicycle that was held to be a car: first its front is seen, then all of it
    const double front_m = 3.0 * static_cast<double>(i * kPeriodNs) * 1e-9;
    const double seen_m = std::min(1.6, 0.8 + 0.08 * i);
    std::vector<Vector2d> points;
    for (double behind_m = seen_m; behind_m > -0.01; behind_m -= 0.2) points.emplace_back(20.0, front_m - behind_m);
    Glimpse glimpse = glimpse_of(points);
    glimpse.start = seen_m < 1.6 ? Edge::kHidden : Edge::kOpen;
    if (i == 0) track = begun({1}, 0, glimpse, 0.5 * M_PI, 1e-4 * Matrix2d::Identity(), kConfig);
    track.youth.add(i * kPeriodNs, glimpse, 1e-4 * Matrix2d::Identity());
  }
  track.body = Body();
  track.body.has_sides = track.body.is_oriented = true;
  track.body.heading_rad = 0.5 * M_PI;
  track.body = with_likely_sizes(track.body, kConfig);
  live_as(track, relived(track, kConfig));
  EXPECT_LT((track.velocity_mps() - Vector2d(0.0, 3.0)).norm(), 1.0);
}

TEST(Youth, MovesWhereItBeganWithTheMiddle) {
  Track track = begun_as_a_front(12);
  const Vector2d way_m = track.position_m() - track.birth_position_m;
  live_as(track, relived(track, kConfig));
  EXPECT_LT((track.position_m() - track.birth_position_m - way_m).norm(), 1e-9);
}

TEST(Youth, FilteredAgainHasPredictedNothingThatWasSeen) {
  Track track = begun_as_a_front(12);
  track.agreement = {0.05, 0.5, 12.0};
  const Life before = life(track);
  live_as(track, relived(track, kConfig));
  EXPECT_EQ(track.agreement.weight, 0.0);
  live_as(track, before);
  EXPECT_EQ(track.agreement.weight, 12.0);
}

TEST(Youth, IsForgottenButForItsEnd) {
  Track track = begun_as_a_front(100);
  EXPECT_EQ(track.youth.size(), 40U);
  EXPECT_EQ(track.youth[39].stamp_ns, 99 * kPeriodNs);
}

}  // namespace
}  // namespace slammot::tracking
