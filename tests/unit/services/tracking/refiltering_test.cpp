#include "services/tracking/refiltering.hpp"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "services/tracking/track_initiation.hpp"

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
  for (double behind_m = 2.0; behind_m > -0.1; behind_m -= 0.2)
    points.emplace_back(20.0, kSpeedMps * time_s - behind_m);
  return points;
}

Observation observation_of(const std::vector<Vector2d>& points) {
  Observation observation;
  observation.points_m = points;
  observation.beam_step_rad = 0.5 * M_PI / 180.0;
  observation.start = Edge::kHidden;
  return observation;
}

/// As if the flank was the front of a car that comes nearer.
Track begun_as_a_front(int scans) {
  const std::vector<Vector2d> first = flank_at(0.0);
  Track track =
      initiated({{1}, 0, observation_of(first), 0.5 * M_PI, 1e-4 * Matrix2d::Identity()}, kConfig);
  for (int i = 0; i < scans; ++i) {
    const std::vector<Vector2d> points = flank_at(static_cast<double>(i * kPeriodNs) * 1e-9);
    track.history.observations.add(i * kPeriodNs, observation_of(points),
                                   1e-4 * Matrix2d::Identity());
  }
  return track;
}

TEST(Refiltering, TurnsABodyThatWentSideways) {
  Track track = begun_as_a_front(12);
  ASSERT_NEAR(std::abs(std::cos(track.extent.footprint().heading_rad)), 1.0, 0.05);
  set_belief(track, refiltered(track, kConfig));
  EXPECT_NEAR(std::abs(std::sin(track.extent.footprint().heading_rad)), 1.0, 0.05);
  EXPECT_TRUE(track.extent.box()->is_oriented);
  EXPECT_LT((track.velocity_mps() - Vector2d(0.0, kSpeedMps)).norm(), 0.5);
  EXPECT_LT(track.position_m().y(),
            kSpeedMps * 11.0 * static_cast<double>(kPeriodNs) * 1e-9 - 1.5);  // behind the front
                                                                              // that is seen
}

TEST(Refiltering, LeavesOpenWhichSideIsTheFlankOfWhatHasNotMoved) {
  Track track = begun_as_a_front(1);
  track.history.observations.add(kPeriodNs, observation_of(flank_at(0.0)),
                                 1e-4 * Matrix2d::Identity());
  set_belief(track, refiltered(track, kConfig));
  EXPECT_FALSE(track.extent.box()->is_oriented);
}

TEST(Refiltering, IsNotFastBecauseItsOtherEndComesIntoView) {
  constexpr int kScans = 24;
  Track track;
  for (int i = 0; i < kScans; ++i) {  // a bicycle that was held to be a car: first its front is
                                      // seen, then all of it
    const double front_m = 3.0 * static_cast<double>(i * kPeriodNs) * 1e-9;
    const double seen_m = std::min(1.6, 0.8 + 0.08 * i);
    std::vector<Vector2d> points;
    for (double behind_m = seen_m; behind_m > -0.01; behind_m -= 0.2)
      points.emplace_back(20.0, front_m - behind_m);
    Observation observation = observation_of(points);
    observation.start = seen_m < 1.6 ? Edge::kHidden : Edge::kOpen;
    if (i == 0)
      track = initiated({{1}, 0, observation, 0.5 * M_PI, 1e-4 * Matrix2d::Identity()}, kConfig);
    track.history.observations.add(i * kPeriodNs, observation, 1e-4 * Matrix2d::Identity());
  }
  track.extent.outline = Box();
  track.extent.box()->is_oriented = true;
  track.extent.footprint().heading_rad = 0.5 * M_PI;
  *track.extent.box() = with_likely_sizes(*track.extent.box(), kConfig);
  set_belief(track, refiltered(track, kConfig));
  EXPECT_LT((track.velocity_mps() - Vector2d(0.0, 3.0)).norm(), 1.0);
}

TEST(Refiltering, MovesWhereItBeganWithTheMiddle) {
  Track track = begun_as_a_front(12);
  const Vector2d travelled_m = track.position_m() - track.history.birth.centre_m;
  set_belief(track, refiltered(track, kConfig));
  EXPECT_LT((track.position_m() - track.history.birth.centre_m - travelled_m).norm(), 1e-9);
}

TEST(Refiltering, FilteredAgainHasPredictedNothingThatWasSeen) {
  Track track = begun_as_a_front(12);
  track.existence.consistency = {0.05, 0.5, 12.0};
  const Belief before = belief_of(track);
  set_belief(track, refiltered(track, kConfig));
  EXPECT_EQ(track.existence.consistency.weight, 0.0);
  set_belief(track, before);
  EXPECT_EQ(track.existence.consistency.weight, 12.0);
}

TEST(Refiltering, IsForgottenButForItsEnd) {
  Track track = begun_as_a_front(100);
  EXPECT_EQ(track.history.observations.size(), 40U);
  EXPECT_EQ(track.history.observations[39].stamp_ns, 99 * kPeriodNs);
}

TEST(Refiltering, DoesNotCountTheShiftOfACentreAsTravel) {
  Track track = begun_as_a_front(3);
  track.existence.travel.anchor_m = track.position_m() - Vector2d(0.2, 0.4);
  Belief belief = belief_of(track);
  belief.estimate.mean.head<2>() += Vector2d(1.5, -0.7);
  const Vector2d place_m = belief.estimate.mean.head<2>();
  set_belief(track, belief);
  ASSERT_LT((track.position_m() - place_m).norm(), 1e-9);
  EXPECT_LT((track.position_m() - track.existence.travel.anchor_m - Vector2d(0.2, 0.4)).norm(),
            1e-9);
}

}  // namespace
}  // namespace slammot::tracking
