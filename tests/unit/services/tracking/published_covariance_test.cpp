#include "services/tracking/published_covariance.hpp"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "services/tracking/publication.hpp"
#include "tests/support/example_tracks.hpp"

namespace slammot::tracking {
namespace {

using testing::followed_car;
using testing::known_car;
using testing::kPeriodS;

/// One sigma of the published centre, across the heading.
double sigma_across_m(const Track& track) {
  return std::sqrt(published(track, 0, TrackingConfig()).covariance(1, 1));
}

Eigen::Matrix4d published_covariance(const Track& track) {
  return published(track, 0, {}).covariance;
}

TEST(PublishedCovariance, IsInThePublishedCovarianceAsFarAsItIsSeen) {
  const TrackingConfig config;
  Track track;
  track.kinematics.estimate.mean << 10.0, 0.0, 1.3, 0.0, 0.0, 0.0;
  track.kinematics.estimate.covariance = 0.01 * track.kinematics.estimate.covariance.Identity();
  const Eigen::Matrix4d by_legs = published(track, 0, config).covariance;
  track.kinematics.gait.variance_m2 = 0.25 * gait_sigma_m(config) * gait_sigma_m(config);
  const Eigen::Matrix4d by_a_coat = published(track, 0, config).covariance;
  EXPECT_NEAR(by_legs(0, 0) - by_a_coat(0, 0), 0.75 * 0.01, 1e-9);
  EXPECT_EQ(by_legs(2, 2), by_a_coat(2, 2));
}

TEST(PublishedCovariance, IsPublishedWithWhatItsHeadingDoesToTheCentreBehindTheSidesThatAreSeen) {
  Track track = followed_car();
  track.extent.box()->is_oriented = true;
  track.extent.box()->axis_variance_rad2 = 0.001;
  track.extent.box()->heading_variance_rad2 = 0.1 * 0.1;
  const double surely_m = sigma_across_m(track);
  track.extent.box()->heading_variance_rad2 = 0.1 * 0.1 + 0.3 * 0.3;
  EXPECT_NEAR(sigma_across_m(track), std::hypot(surely_m, 0.3 * 2.2), 1e-6);
}

TEST(PublishedCovariance, MayBeTheFrameOrTheRiderOfABicycle) {
  Track track = followed_car();
  track.extent.box()->is_oriented = true;
  track.extent.box()->axis_variance_rad2 = 0.001;
  const double of_a_car_m = sigma_across_m(track);
  track.extent.box()->kind = Kind::kBicycle;
  EXPECT_GT(sigma_across_m(track), std::hypot(of_a_car_m, 0.1));
}

TEST(PublishedCovariance, DrawnAsACarMayBeTheBicycleThatItsSpeedSaysItIs) {
  Track track = followed_car();
  track.extent.box()->is_oriented = true;
  track.extent.box()->axis_variance_rad2 = 0.001;
  track.classification.probability = {0.0, 0.0, 1.0, 0.0};
  const double surely_m = sigma_across_m(track);
  track.classification.probability = {0.0, 0.5, 0.5, 0.0};
  EXPECT_NEAR(sigma_across_m(track), std::hypot(surely_m, std::sqrt(0.5) * 0.5 * (1.8 - 0.65)),
              1e-3);
}

TEST(PublishedCovariance, OfWhichNoSideTellsTheHeadingIsNotPublishedAsIfItsCourseDidSurely) {
  Track track = followed_car();
  track.extent.box()->is_oriented = true;
  track.extent.box()->heading_variance_rad2 = 0.02 * 0.02;
  track.extent.box()->axis_variance_rad2 = 0.001;
  EXPECT_LT(sigma_across_m(track), 0.2);
  track.extent.box()->axis_variance_rad2 = 10.0;
  EXPECT_GT(sigma_across_m(track), 0.2);
}

TEST(PublishedCovariance, IsKnownAcrossAsWellAsItsSidesKeepTheirHeading) {
  HeadingNoise straight;
  HeadingNoise swaying;
  for (int i = 0; i < 200; ++i) {
    straight = with_heading(straight, 0.005, 0.0025, kPeriodS);
    swaying = with_heading(swaying, 0.05, 0.0025, kPeriodS);
  }
  EXPECT_LT(straight.share, 0.1);
  EXPECT_NEAR(swaying.share, 1.0, 0.05);
  Track track = known_car();
  const double as_taken_m2 = published(track, 0, {}).covariance(1, 1);
  track.extent.heading_noise = straight;
  EXPECT_LT(published(track, 0, {}).covariance(1, 1), as_taken_m2 - 0.004);
  track.extent.box()->axis_variance_rad2 = 1.0;
  EXPECT_GT(published(track, 0, {}).covariance(1, 1), as_taken_m2) << "no side tells the heading";
}

TEST(PublishedCovariance, IsKnownAsWellAsBodiesHereAreBoxes) {
  Track track = known_car();
  track.kinematics.estimate.covariance = 0.0009 * track.kinematics.estimate.covariance.Identity();
  track.extent.range_m = 5.0;
  const Eigen::Matrix4d as_taken = published_covariance(track);
  RoadUsers of_boxes_here;
  of_boxes_here.shape_share = 0.4;
  track.extent.footprint().road_users = &of_boxes_here;
  const Eigen::Matrix4d of_boxes = published_covariance(track);
  EXPECT_LT(of_boxes(0, 0), as_taken(0, 0) - 0.0007);
  EXPECT_LT(of_boxes(1, 1), as_taken(1, 1) - 0.006);
  EXPECT_EQ(of_boxes(2, 2), as_taken(2, 2));
  track.extent.range_m = 50.0;
  EXPECT_GT(published_covariance(track)(0, 0), of_boxes(0, 0) + 0.0002)
      << "the scanner errs as it did";
  track.extent.box()->axis_variance_rad2 = 1.0;
  EXPECT_GT(published_covariance(track)(1, 1), as_taken(1, 1)) << "no side tells the heading";
}

TEST(PublishedCovariance, MayBeAnywhereInItsBoxWhereBeamsPassThroughIt) {
  Track track = known_car();
  const Eigen::Matrix4d solid = published_covariance(track);
  for (int i = 0; i < 100; ++i)
    track.existence.passage = with_beams(track.existence.passage, 1, 19, kPeriodS);
  EXPECT_EQ(published_covariance(track)(0, 0), solid(0, 0)) << "a beam or two pass by a corner";
  for (int i = 0; i < 100; ++i)
    track.existence.passage = with_beams(track.existence.passage, 16, 4, kPeriodS);
  EXPECT_GT(std::sqrt(published_covariance(track)(0, 0)), 1.0);
  EXPECT_GT(std::sqrt(published_covariance(track)(1, 1)), 0.4);
  for (int i = 0; i < 100; ++i)
    track.existence.passage = with_beams(track.existence.passage, 0, 20, kPeriodS);
  EXPECT_NEAR(published_covariance(track)(0, 0), solid(0, 0), 1e-3) << "that is over";
}

TEST(PublishedCovariance, MayBeAnywhereInItsBoxWhereEchoesLieFarOffItsSides) {
  Track track = known_car();
  track.extent.range_m = 10.0;
  track.existence.consistency.off_sides_m = 0.05;
  const Eigen::Matrix4d near = published_covariance(track);
  track.existence.consistency.off_sides_m = 0.3;
  EXPECT_GT(std::sqrt(published_covariance(track)(0, 0)), std::sqrt(near(0, 0)) + 0.5);
  track.existence.consistency.off_sides_m = 0.15;
  track.extent.range_m = 50.0;
  EXPECT_LT(std::sqrt(published_covariance(track)(0, 0)), std::sqrt(near(0, 0)) + 0.05)
      << "far away that is usual";
}

}  // namespace
}  // namespace slammot::tracking
