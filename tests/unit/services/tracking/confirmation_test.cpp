#include "services/tracking/confirmation.hpp"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/example_tracks.hpp"

#include "services/tracking/evidence_limits.hpp"

namespace slammot::tracking {
namespace {

using testing::among_people;
using testing::followed_car;
using testing::out_from_behind_others;

/// A car drawn where its echoes are not.
Track misdrawn_car() {
  Track track = followed_car();
  track.existence.consistency = {0.4, 9.0, 10.0};
  return track;
}

TEST(Confirmation, IsWrongOfTwoDrawnOverEachOtherIfItsEchoesAreNotWhereItIs) {
  const TrackingConfig config;
  const Track right = followed_car();
  const Track wrong = misdrawn_car();
  EXPECT_EQ(inconsistent_one(right, wrong, config), &wrong);
  EXPECT_EQ(inconsistent_one(wrong, right, config), &wrong);
  EXPECT_EQ(inconsistent_one(right, right, config), nullptr);
  EXPECT_EQ(inconsistent_one(wrong, wrong, config), nullptr);
  Track small;
  EXPECT_EQ(inconsistent_one(wrong, small, config), nullptr)
      << "what has no sides may be an echo of anything";
}

TEST(Confirmation, HasNotProvenToMoveWhileItsSpeedCannotBeToldFromNone) {
  const TrackingConfig config;
  Track track;
  track.existence.score = kConfirmScore;
  track.existence.hits = evidence_limits(config).least_hits;
  track.existence.motion = {kSureMovedVotes, 0.0, 0.0};  // a thin post: beams went past it
                                                         // on both sides a moment ago
  track.history.birth.R = 0.01 * Eigen::Matrix2d::Identity();
  track.kinematics.estimate.mean << 1.0, 0.0, 0.5, 0.0, 0.0, 0.0;  // drawn at a stray echo, a metre
                                                                   // beside
  track.kinematics.estimate.covariance = 0.01 * filters::Matrix6::Identity();
  track.kinematics.estimate.covariance.block<2, 2>(2, 2) = 0.16 * Eigen::Matrix2d::Identity();
  EXPECT_FALSE(is_confirmable(track, config));
  track.kinematics.estimate.mean(2) = 1.0;
  EXPECT_TRUE(is_confirmable(track, config));
}

TEST(Confirmation, WantsAWayThatNoSwayingBranchGoes) {
  const TrackingConfig config;
  Track track;
  track.existence.score = kConfirmScore;
  track.existence.hits = evidence_limits(config).least_hits;
  track.existence.motion = {kLeastMovedVotes, kLeastMovedVotes, 0.0};  // votes are divided
  track.history.birth.R = 1e-4 * Eigen::Matrix2d::Identity();
  track.kinematics.estimate.covariance = 1e-4 * filters::Matrix6::Identity();
  track.kinematics.estimate.mean << 0.25, 0.0, 1.0, 0.0, 0.0, 0.0;
  EXPECT_FALSE(is_confirmable(track, config));
  track.kinematics.estimate.mean(0) = 0.4;
  EXPECT_TRUE(is_confirmable(track, config));
}

TEST(Confirmation, HasMovedByOneVoteIfByTheMapItHasComeOutOfNowhere) {
  const TrackingConfig config;
  const Track track = out_from_behind_others(config);
  EXPECT_TRUE(is_confirmable(track, config));
  Track once = track;
  once.existence.motion = {0.9, 0.0, 32.0};
  EXPECT_TRUE(is_confirmable(once, config));
  Track unmapped = track;  // say, what a van hid for as long as there is a map
  unmapped.existence.tentative.in_free_space = 20.0;
  EXPECT_FALSE(is_confirmable(unmapped, config));
  Track standing = track;
  standing.existence.tentative.stood = 10.0;
  EXPECT_FALSE(is_confirmable(standing, config));
  Track forgotten = track;  // a wall that the map holds to be free: nothing ever came there
  forgotten.existence.motion = {0.0, 0.0, 33.0};
  EXPECT_FALSE(is_confirmable(forgotten, config));
  Track crumb = track;
  crumb.existence.mean_echoes = 2.0;
  EXPECT_FALSE(is_confirmable(crumb, config));
  EXPECT_FALSE(appeared_in_free_space(track, among_people()));
}

TEST(Confirmation, IsConfirmedAsSoonAsItCanBePublishedIfItComesOutOfNowhereAsPredicted) {
  const TrackingConfig config;
  Track track = out_from_behind_others(config);
  track.existence.motion = {20.0, 0.0, 10.0};
  track.kinematics.estimate.covariance.block<2, 2>(2, 2) =
      0.65 * 0.65 * Eigen::Matrix2d::Identity();
  track.existence.consistency = {0.05, 0.6, 5.0};
  EXPECT_TRUE(is_confirmable(track, config));
  Track surprising = track;
  surprising.existence.consistency.nis = 2.5;
  EXPECT_FALSE(is_confirmable(surprising, config));
  Track unmapped = track;
  unmapped.existence.tentative.in_free_space = 20.0;
  EXPECT_FALSE(is_confirmable(unmapped, config));
}

TEST(Confirmation, IsNotConfirmedAsABodyOnTheSidesOfWhichItsEchoesDoNotLie) {
  const TrackingConfig config;
  Track track = out_from_behind_others(config);
  track.extent.outline = Box();
  track.existence.consistency = {0.15, 0.6, 5.0};
  EXPECT_TRUE(is_confirmable(track, config));
  EXPECT_FALSE(misfits_only(track, config));
  track.existence.consistency.off_sides_m = 0.25;  // say, two who walk, held to be a car
  EXPECT_FALSE(is_confirmable(track, config));
  EXPECT_TRUE(misfits_only(track, config)) << "nothing else keeps it";
  track.existence.motion = {};
  EXPECT_FALSE(misfits_only(track, config));
}

TEST(Confirmation, HasComeFromWhereItWasByTheBodyThatItHasByNow) {
  const TrackingConfig config;
  Track track = out_from_behind_others(config);
  track.extent.outline = Box();
  track.extent.box()->is_oriented = true;
  track.extent.footprint().heading_rad = 0.0;
  *track.extent.box() = with_likely_sizes(*track.extent.box(), config);
  track.kinematics.estimate.mean.head<2>() << 28.2, 0.0;
  track.history.birth.centre_m = {24.0, 0.0};
  track.history.birth.R = 9.0 * Eigen::Matrix2d::Identity();  // all that was seen of it was of some
                                                              // side of something
  EXPECT_FALSE(is_confirmable(track, config));
  std::vector<Eigen::Vector2d> rear;
  for (double y_m = -0.9; y_m < 0.91; y_m += 0.2) rear.emplace_back(20.0, y_m);
  Observation observation;
  observation.points_m = rear;
  observation.beam_step_rad = 0.5 * M_PI / 180.0;
  track.history.observations.add(0, observation, 1e-4 * Eigen::Matrix2d::Identity());
  EXPECT_TRUE(is_confirmable(track, config));
}

TEST(Confirmation, HasComeNoWayByTheJumpThatItHasJustMade) {
  const TrackingConfig config;
  Track track;
  track.existence.score = kConfirmScore;
  track.existence.hits = evidence_limits(config).least_hits;
  track.existence.motion = {2.0 * kLeastMovedVotes, 0.0, 0.0};
  track.history.birth.R = 0.01 * Eigen::Matrix2d::Identity();
  track.kinematics.estimate.mean << 0.9, 0.0, 1.5, 0.0, 0.0, 0.0;
  track.kinematics.estimate.covariance = 0.01 * filters::Matrix6::Identity();
  track.kinematics.innovation_m = 0.7;  // from one leg of a chair to the next
  EXPECT_FALSE(is_confirmable(track, config));
  track.kinematics.innovation_m = 0.2;
  EXPECT_TRUE(is_confirmable(track, config));
}

}  // namespace
}  // namespace slammot::tracking
