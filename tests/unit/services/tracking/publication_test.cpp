#include "services/tracking/publication.hpp"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/example_tracks.hpp"

namespace slammot::tracking {
namespace {

using testing::followed_car;

TEST(Publication, IsFollowedButNotPublishedWhileItsVelocityIsHardlyKnown) {
  const TrackingConfig config;
  Track track = followed_car();
  EXPECT_TRUE(published(track, 0, config).confirmed);
  track.kinematics.estimate.covariance.block<2, 2>(2, 2) = 1.0 * Eigen::Matrix2d::Identity();
  EXPECT_FALSE(published(track, 0, config).confirmed);
  EXPECT_TRUE(track.existence.confirmed);
}

TEST(Publication, WhoseVelocityWasUnknownIsNotPublishedWhileItComesFromElsewhereThanItShould) {
  const TrackingConfig config;
  Track track = followed_car();
  track.existence.consistency.nis = 6.0;
  EXPECT_TRUE(published(track, 0, config).confirmed) << "it has been seen all the time";
  track.existence.velocity_check.known_since_ns = 1;
  EXPECT_FALSE(published(track, 0, config).confirmed);
  track.existence.consistency.nis = 3.0;
  EXPECT_TRUE(published(track, 0, config).confirmed);
}

TEST(Publication, AsOccludedGoesOnForATrackThatWasPublishedWhileItMayExist) {
  constexpr std::int64_t kSecondNs = 1'000'000'000;
  const TrackingConfig config;
  Track track = followed_car();
  track.history.last_seen_ns = kSecondNs;
  EXPECT_FALSE(published(track, 2 * kSecondNs, config).confirmed) << "it was never published";
  track.history.first_published_ns = 0;
  const flow::TrackedObject hidden = published(track, 2 * kSecondNs, config);
  EXPECT_TRUE(hidden.confirmed);
  EXPECT_TRUE(hidden.occluded);
  EXPECT_FALSE(published(track, kSecondNs, config).occluded);
  EXPECT_FALSE(published(track, 7 * kSecondNs, config).confirmed);
  track.existence.score = -0.1;
  EXPECT_FALSE(published(track, 2 * kSecondNs, config).confirmed);
}

}  // namespace
}  // namespace slammot::tracking
