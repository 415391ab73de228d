#include "services/tracking/reidentification.hpp"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/example_tracks.hpp"

namespace slammot::tracking {
namespace {

using testing::followed_car;

constexpr std::int64_t kSecondNs = 1'000'000'000;

/// A car unseen since 1 s, and one that was first seen at 4 s, at the same place and velocity.
struct LostAndFound {
  LostAndFound() {
    for (Track& track : tracks) {
      track.existence.hits = 50;
      track.classification.probability = {0.0, 0.0, 1.0, 0.0};
      track.kinematics.estimate.mean.segment<2>(2) = Eigen::Vector2d(6.0, 0.0);
    }
    lost().track_id = lost().object_id = {3};
    lost().history.last_seen_ns = kSecondNs;
    lost().history.first_seen_ns = lost().history.first_published_ns.emplace(100);
    lost().kinematics.estimate.covariance.topLeftCorner<4, 4>().diagonal() << 9.0, 1.0, 2.0, 0.2;
    found().track_id = found().object_id = {8};
    found().history.first_seen_ns = 4 * kSecondNs;
    found().history.last_seen_ns = 5 * kSecondNs;
  }
  Track& lost() { return tracks[0]; }
  Track& found() { return tracks[1]; }

  TrackingConfig config;
  std::vector<Track> tracks{followed_car(), followed_car()};
};

TEST(Reidentification, FindsTheTrackWhosePredictionAgrees) {
  LostAndFound scene;
  EXPECT_EQ(track_of_same_object(scene.found(), scene.tracks, scene.config), 0U);
  continue_track(scene.lost(), scene.found(), scene.config);
  EXPECT_EQ(scene.found().object_id.value, 3U);
  EXPECT_EQ(scene.found().track_id.value, 8U);
  EXPECT_EQ(scene.found().history.first_seen_ns, 100);
  EXPECT_EQ(scene.lost().existence.hits, 0) << "marked for removal";
}

TEST(Reidentification, IsLessLikelyFartherFromThePrediction) {
  LostAndFound scene;
  double before = log_odds_of_same_object(scene.lost(), scene.found(), scene.config);
  for (const double off_m : {3.0, 6.0, 9.0}) {
    scene.found().kinematics.estimate.mean.x() = scene.lost().position_m().x() + off_m;
    const double odds = log_odds_of_same_object(scene.lost(), scene.found(), scene.config);
    EXPECT_LT(odds, before);
    before = odds;
  }
  scene.found().kinematics.estimate.mean.x() = scene.lost().position_m().x() + 15.0;
  EXPECT_FALSE(track_of_same_object(scene.found(), scene.tracks, scene.config));
}

TEST(Reidentification, RefusesAnotherVelocityClassOrATrackSeenMeanwhile) {
  LostAndFound oncoming;
  oncoming.found().kinematics.estimate.mean.segment<2>(2) = Eigen::Vector2d(-6.0, 0.0);
  EXPECT_FALSE(track_of_same_object(oncoming.found(), oncoming.tracks, oncoming.config));
  LostAndFound pedestrian;
  pedestrian.found().classification.probability = {1.0, 0.0, 0.0, 0.0};
  EXPECT_FALSE(track_of_same_object(pedestrian.found(), pedestrian.tracks, pedestrian.config));
  LostAndFound seen;
  seen.lost().history.last_seen_ns = 4 * kSecondNs + 500'000'000;
  EXPECT_FALSE(track_of_same_object(seen.found(), seen.tracks, seen.config));
}

/// The found track after some scans, not confirmed yet.
LostAndFound with_tentative() {
  LostAndFound scene;
  scene.found().existence = {};
  scene.found().existence.hits = 8;
  scene.found().existence.score = 3.0;
  scene.found().kinematics.estimate.covariance.block<2, 2>(2, 2).diagonal().setConstant(2.0);
  scene.lost().history.is_hidden = true;
  return scene;
}

TEST(Reidentification, IsOfATentativeTrackIfItIsWhereAHiddenObjectIsExpected) {
  LostAndFound scene = with_tentative();
  EXPECT_TRUE(may_have_returned(scene.found(), scene.config));
  EXPECT_EQ(track_of_same_object(scene.found(), scene.tracks, scene.config), 0U);
  scene.lost().history.is_hidden = false;  // it would have been given the echoes
  EXPECT_FALSE(track_of_same_object(scene.found(), scene.tracks, scene.config));
}

TEST(Reidentification, OfATentativeTrackNeedsALostOneThatHadMovedAndIsLessCertainOfItsPlace) {
  LostAndFound standing = with_tentative();
  standing.lost().existence.travel.travelled_m = 0.0;
  EXPECT_FALSE(track_of_same_object(standing.found(), standing.tracks, standing.config));
  LostAndFound certain = with_tentative();
  certain.lost().kinematics.estimate.covariance.topLeftCorner<2, 2>().diagonal().setConstant(1e-4);
  EXPECT_FALSE(track_of_same_object(certain.found(), certain.tracks, certain.config));
}

TEST(Reidentification, AsksMoreOfATentativeTrackTheLessItProbablyExists) {
  LostAndFound scene = with_tentative();
  const double odds = log_odds_of_same_object(scene.lost(), scene.found(), scene.config);
  scene.found().existence.score = -1.0 - odds;
  EXPECT_FALSE(track_of_same_object(scene.found(), scene.tracks, scene.config));
  scene.found().existence.confirmed = true;
  EXPECT_EQ(track_of_same_object(scene.found(), scene.tracks, scene.config), 0U);
}

TEST(Reidentification, IsNotOfATentativeTrackThatMayStandOrWhoseExtentIsWrong) {
  LostAndFound standing = with_tentative();
  standing.found().kinematics.estimate.mean.segment<2>(2).setZero();
  EXPECT_FALSE(may_have_returned(standing.found(), standing.config));
  LostAndFound stationary = with_tentative();
  stationary.found().existence.motion = {1.0, 10.0, 8.0};
  EXPECT_FALSE(may_have_returned(stationary.found(), stationary.config));
  LostAndFound misfit = with_tentative();
  misfit.found().existence.consistency.off_sides_m = 0.3;
  EXPECT_FALSE(may_have_returned(misfit.found(), misfit.config));
  LostAndFound surprising = with_tentative();
  surprising.found().existence.consistency.nis = 3.0;
  EXPECT_FALSE(may_have_returned(surprising.found(), surprising.config));
  LostAndFound young = with_tentative();
  young.found().existence.hits = 4;
  EXPECT_FALSE(may_have_returned(young.found(), young.config));
}

TEST(Reidentification, MakesTheVelocityMoreCertainByThePrediction) {
  LostAndFound scene = with_tentative();
  scene.found().kinematics.estimate.mean.x() += 1.0;
  scene.found().kinematics.estimate.mean(2) = 7.0;
  const filters::MotionState before = scene.found().kinematics.estimate;
  continue_track(scene.lost(), scene.found(), scene.config);
  const filters::MotionState& after = scene.found().kinematics.estimate;
  EXPECT_NEAR(after.mean(2), (7.0 / 2.0 + 6.0 / 2.0) / (1.0 / 2.0 + 1.0 / 2.0), 0.05);
  EXPECT_NEAR(after.covariance(2, 2), 1.0, 0.05);
  EXPECT_NEAR(after.mean(0), before.mean(0), 0.05) << "the echoes tell where it is";
  EXPECT_LT(after.covariance(0, 0), before.covariance(0, 0));
}

}  // namespace
}  // namespace slammot::tracking
