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
  continue_track(scene.lost(), scene.found());
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

}  // namespace
}  // namespace slammot::tracking
