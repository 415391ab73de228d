#include "services/tracking/track.hpp"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "services/tracking/publication.hpp"
#include "services/tracking/track_initiation.hpp"

namespace slammot::tracking {
namespace {

TEST(Track, ThatIsTooFastForLegsIsNobodyWhoWalksFromTheFirstScanOn) {
  const TrackingConfig config;
  Track corner;
  corner.extent.footprint().length = corner.extent.footprint().width = {0.5, 1.0};
  corner.kinematics.estimate.mean << 20.0, 0.0, 9.0, 0.0, 0.0, 0.0;
  corner.kinematics.estimate.covariance = 0.04 * corner.kinematics.estimate.covariance.Identity();
  confirm(corner, 0, config);
  EXPECT_TRUE(corner.existence.confirmed);
  EXPECT_EQ(corner.classification.likeliest, flow::ObjectClass::kCar);
  EXPECT_GT(std::sqrt(published(corner, 0, config).covariance(0, 0)), 1.5);  // its middle may be
                                                                             // half a car away
}

TEST(Track, IsShiftedWithThePlacesWhereItBeganAndThatItCameFrom) {
  Track track;
  const Eigen::Vector2d by_m{0.4, -0.3};
  const Eigen::Vector2d birth_m = track.history.birth.centre_m;
  const Eigen::Vector2d anchor_m = track.existence.travel.anchor_m;
  shift(track, by_m, TrackingConfig{});
  EXPECT_TRUE(track.history.birth.centre_m.isApprox(birth_m + by_m));
  EXPECT_TRUE(track.existence.travel.anchor_m.isApprox(anchor_m + by_m));
}

TEST(Track, MayTurnTheFasterTheSmallerItIs) {
  const std::vector<Eigen::Vector2d> points{{20.0, -0.9}, {20.0, -0.3}, {20.0, 0.3}, {20.0, 0.9}};
  const auto variance_after_a_second = [&](double size_scale) {
    TrackingConfig config;
    config.extent.size_scale = size_scale;
    Observation observation;
    observation.points_m = points;
    observation.beam_step_rad = 0.5 * M_PI / 180.0;
    Track track =
        initiated({{1}, 0, observation, 0.5 * M_PI, 1e-4 * Eigen::Matrix2d::Identity()}, config);
    track.extent.box()->heading_variance_rad2 = track.extent.box()->axis_variance_rad2 = 0.0;
    predict(track, 1.0, config);
    EXPECT_EQ(track.extent.box()->axis_variance_rad2, track.extent.box()->heading_variance_rad2);
    return track.extent.box()->heading_variance_rad2;
  };
  EXPECT_GT(variance_after_a_second(1.0), 0.0);
  EXPECT_NEAR(variance_after_a_second(0.1), 10.0 * variance_after_a_second(1.0), 1e-9);
}

}  // namespace
}  // namespace slammot::tracking
