#include "services/tracking/road_user_learning.hpp"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "services/tracking/publication.hpp"
#include "tests/support/example_tracks.hpp"

namespace slammot::tracking {
namespace {

using testing::known_car;

/// Followed for so long, to be a person in a coat, of whom less swings than the settings take for
/// it.
Track walker_in_a_coat(double followed_s, const TrackingConfig& config) {
  Track track;
  track.existence.confirmed = true;
  track.kinematics.estimate.mean << 10.0, 0.0, 1.3, 0.0, 0.0, 0.0;
  track.kinematics.estimate.covariance = 0.01 * track.kinematics.estimate.covariance.Identity();
  track.kinematics.gait.variance_m2 = std::pow(0.3 * gait_sigma_m(config), 2);
  track.history.last_seen_ns = static_cast<std::int64_t>(followed_s * 1e9);
  return track;
}

double shape_share_after(const Track& track) {
  RoadUsersSeen seen;
  for (int i = 0; i < 20; ++i) learn_outline_error(seen, track, {});
  return seen.known().shape_share;
}

TEST(RoadUserLearning, OfThoseWhoWalkedHereIsThatOfWhoComes) {
  const TrackingConfig config;
  RoadUsersSeen seen;
  for (int i = 0; i < 20; ++i) learn_gait(seen, walker_in_a_coat(5.0, config), config);
  EXPECT_NEAR(seen.known().swing_share, 0.3, 0.1);
  Track newcomer = walker_in_a_coat(0.1, config);
  newcomer.kinematics.gait.variance_m2.reset();
  const double as_taken_m2 = published(newcomer, 0, config).covariance(0, 0);
  const RoadUsers known = seen.known();
  newcomer.extent.footprint().road_users = &known;
  EXPECT_LT(published(newcomer, 0, config).covariance(0, 0), as_taken_m2 - 0.008);
}

TEST(RoadUserLearning, IsLearnedOfThoseOnlyWhoWereFollowedForAWhileAndNotWhereOnlyPeopleMove) {
  const TrackingConfig config;
  RoadUsersSeen seen;
  for (int i = 0; i < 20; ++i) learn_gait(seen, walker_in_a_coat(1.0, config), config);
  TrackingConfig indoors;
  indoors.extent.longest_body_m = 2.0;
  for (int i = 0; i < 20; ++i) learn_gait(seen, walker_in_a_coat(5.0, indoors), indoors);
  EXPECT_EQ(seen.known().swing_share, 1.0);
}

TEST(RoadUserLearning, IsAsWideAsLiesBetweenWhatWasSeenFromEdgeToEdgeAndTheMostThatWasSeen) {
  RoadUsersSeen seen;
  Track track = known_car();
  track.extent.box()->evidence.width = {1.95, {1.65, 0.004}};
  for (int i = 0; i < 40; ++i) learn_sizes(seen, track, {});
  EXPECT_NEAR(seen.known().kinds[1].width_m, 1.8, 0.03);
}

TEST(RoadUserLearning, IsOneOfThoseHereIfItsSizesAreSurelyKnown) {
  const auto length_sigma_m_after = [](const Track& track) {
    RoadUsersSeen seen;
    for (int i = 0; i < 10; ++i) learn_sizes(seen, track, {});
    return seen.known().kinds[1].length_sigma_m;
  };
  const double unknown_m = RoadUsersSeen().known().kinds[1].length_sigma_m;
  EXPECT_LT(length_sigma_m_after(known_car()), 0.7 * unknown_m);
  Track other = known_car();
  other.existence.confirmed = false;
  EXPECT_EQ(length_sigma_m_after(other), unknown_m);
  other = known_car();
  other.existence.travel.travelled_m = 0.0;
  EXPECT_EQ(length_sigma_m_after(other), unknown_m) << "a piece of something";
  other = known_car();
  other.extent.box()->evidence.length.whole = {0.0, 1e6};
  *other.extent.box() = with_likely_sizes(*other.extent.box(), {});
  EXPECT_EQ(length_sigma_m_after(other), unknown_m) << "only its back was seen";
}

TEST(RoadUserLearning, TellsHowFarEchoesLieOffVehiclesThatWereFollowedForLong) {
  Track track = known_car();
  track.extent.outline_error = {0.4 * 800.0, 800.0, 40};
  EXPECT_LT(shape_share_after(track), 0.4);
  Track other = track;
  other.extent.outline_error = {0.4 * 80.0, 80.0, 4};
  EXPECT_EQ(shape_share_after(other), 1.0);
  other = track;
  other.existence.travel.travelled_m = 0.0;
  EXPECT_EQ(shape_share_after(other), 1.0) << "a piece of something";
  other = track;
  other.extent.box()->kind = Kind::kBicycle;
  EXPECT_EQ(shape_share_after(other), 1.0);
}

}  // namespace
}  // namespace slammot::tracking
