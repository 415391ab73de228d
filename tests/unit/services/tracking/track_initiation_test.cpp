#include "services/tracking/track_initiation.hpp"

#include <vector>

#include <gtest/gtest.h>

#include "services/tracking/publication.hpp"
#include "tests/support/example_tracks.hpp"

namespace slammot::tracking {
namespace {

using Eigen::Matrix2d;
using Eigen::Vector2d;

const TrackingConfig kConfig;

/// Of something this wide, 10 m ahead of the laser.
Track initiated_with(double width_m) {
  std::vector<Vector2d> points_m;
  for (double y_m = -0.5 * width_m; y_m <= 0.5 * width_m + 1e-9; y_m += 0.1)
    points_m.emplace_back(10.0, y_m);
  Observation observation;
  observation.points_m = points_m;
  observation.beam_step_rad = 0.01;
  return initiated({{7}, 123, observation, 1.57, 0.01 * Matrix2d::Identity()}, kConfig);
}

TEST(TrackInitiation, MakesABlobOfASmallObjectAndABoxOfALargeOne) {
  EXPECT_EQ(initiated_with(0.4).extent.box(), nullptr);
  EXPECT_NE(initiated_with(1.8).extent.box(), nullptr);
}

TEST(TrackInitiation, BeginsTentativeAtRestAndWithOneHit) {
  const Track track = initiated_with(0.4);
  EXPECT_EQ(track.track_id.value, 7U);
  EXPECT_FALSE(track.existence.confirmed);
  EXPECT_EQ(track.existence.hits, 1);
  EXPECT_EQ(track.existence.score, kBirthScore);
  EXPECT_EQ(track.velocity_mps(), Vector2d::Zero());
  EXPECT_EQ(track.history.first_seen_ns, 123);
  EXPECT_EQ(track.history.birth.centre_m, track.position_m());
  EXPECT_FALSE(track.extent.contour_in_odom_m.empty());
}

TEST(TrackInitiation, CountsTheErrorOfThePose) {
  const Track track = initiated_with(0.4);
  EXPECT_NEAR((track.kinematics.position_covariance_m2() - track.history.birth.R -
               0.01 * Matrix2d::Identity())
                  .norm(),
              0.0, 1e-12);
}

TEST(TrackInitiation, LeavesNothingOfTheTrackWhoseMemoryItUses) {
  const std::vector<Vector2d> points_m = {{10.0, 0.0}, {10.0, 0.2}};
  Observation observation;
  observation.points_m = points_m;
  observation.beam_step_rad = 0.01;
  Track used = testing::known_car();
  used.existence.velocity_check.is_refuted = true;
  used.kinematics.gait.variance_m2 = 1.0;
  used.history.observations.add(1, observation, Matrix2d::Identity());
  const FirstObservation first{{7}, 123, observation, 1.57, 0.01 * Matrix2d::Identity()};
  initiate(used, first, kConfig, kRoadUsersAnywhere);
  const Track fresh = initiated(first, kConfig);
  EXPECT_EQ(used.extent.box(), nullptr);
  EXPECT_EQ(used.existence.confirmed, fresh.existence.confirmed);
  EXPECT_EQ(used.existence.travel.travelled_m, fresh.existence.travel.travelled_m);
  EXPECT_FALSE(used.existence.velocity_check.is_refuted);
  EXPECT_FALSE(used.kinematics.gait.variance_m2.has_value());
  EXPECT_EQ(used.history.observations.size(), 0U);
  EXPECT_EQ(used.kinematics.estimate.mean, fresh.kinematics.estimate.mean);
}

TEST(TrackInitiation, OfAPublishedTrackKeepsIdentityMotionAndExtent) {
  Track track = testing::followed_car();
  track.object_id = {42};
  track.history.last_seen_ns = 900;
  const flow::TrackedObject object = published(track, 1000, kConfig);
  const Track again = track_from_message(object, kConfig);
  EXPECT_EQ(again.track_id.value, 42U);
  EXPECT_EQ(again.existence.confirmed, object.confirmed);
  EXPECT_NEAR((again.position_m() - object.position_in_odom_m).norm(), 0.0, 1e-12);
  EXPECT_NEAR((again.velocity_mps() - object.velocity_in_odom_mps).norm(), 0.0, 1e-12);
  EXPECT_NEAR(existence_of(again.existence.score), object.existence, 1e-6);
  ASSERT_NE(again.extent.box(), nullptr);
  EXPECT_NEAR(again.footprint().length.value_m, object.length_m, 0.3);
  EXPECT_EQ(again.history.last_seen_ns, 900);
}

}  // namespace
}  // namespace slammot::tracking
