#include "services/tracking/heading_update.hpp"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "services/tracking/measurement_update.hpp"
#include "services/tracking/track_initiation.hpp"
#include "tests/support/example_tracks.hpp"

namespace slammot::tracking {
namespace {

using testing::followed_car;
using testing::kPeriodS;

/// After a scan with two echoes of a car that was going at this velocity, its axis known to this.
Track car_after_two_echoes(double axis_sigma_rad, const Eigen::Vector2d& velocity_mps,
                           double velocity_sigma_mps, bool is_oriented) {
  const TrackingConfig config;
  Track track = followed_car();
  *track.extent.box() = with_likely_sizes(*track.extent.box(), config);
  track.extent.box()->is_oriented = is_oriented;
  track.extent.footprint().heading_rad = track.extent.box()->axis_rad = 0.0;
  track.extent.box()->heading_variance_rad2 = 1e-4;
  track.extent.box()->axis_variance_rad2 = axis_sigma_rad * axis_sigma_rad;
  filters::MotionState state;
  state.mean << 20.0, 0.0, velocity_mps.x(), velocity_mps.y(), 0.0, 0.0;
  state.covariance = velocity_sigma_mps * velocity_sigma_mps * filters::Matrix6::Identity();
  restart_from(track.kinematics, state, config);
  const std::vector<Eigen::Vector2d> points = {{17.8, -0.2}, {17.8, 0.2}};
  Observation observation;
  observation.points_m = points;
  observation.beam_step_rad = 0.5 * M_PI / 180.0;
  EXPECT_TRUE(update(track, 27'000'000, observation, 1e-4 * Eigen::Matrix2d::Identity(), config));
  return track;
}

TEST(HeadingUpdate,
     IsSteeredForAsLongAsItsAxisTellsWhichSideIsTheFlankButLessWhileNoSideTellsTheAxis) {
  const auto speed_across_mps = [](double axis_sigma_rad) {
    return car_after_two_echoes(axis_sigma_rad, {3.0, 1.5}, 1.0, true).velocity_mps().y();
  };
  const double told_mps = speed_across_mps(0.13);
  const double remembered_mps = speed_across_mps(0.24);
  EXPECT_GT(remembered_mps, told_mps + 0.5);
  EXPECT_LT(remembered_mps, speed_across_mps(0.3) - 0.1);
}

TEST(HeadingUpdate, IsNotOrientedByACourseHalfwayBetweenTwoSidesForAsLongAsItsAxisTellsThem) {
  const auto is_oriented = [](double axis_sigma_rad) {
    return car_after_two_echoes(axis_sigma_rad, {4.0, 4.0}, 0.3, false).extent.box()->is_oriented;
  };
  EXPECT_FALSE(is_oriented(0.24));
  EXPECT_TRUE(is_oriented(0.3));
}

TEST(HeadingUpdate, DoesNotTurnByWhatIsRound) {
  const TrackingConfig config;
  const std::vector<Eigen::Vector2d> points{{20.0, -0.9}, {20.0, -0.3}, {20.0, 0.3}, {20.0, 0.9}};
  const auto heading_after = [&](double off_m) {
    Observation observation;
    observation.points_m = points;
    observation.beam_step_rad = 0.5 * M_PI / 180.0;
    observation.side = Side{0.5 * M_PI + 0.3, 1.8, off_m};
    Track track =
        initiated({{1}, 0, observation, 0.5 * M_PI, 1e-4 * Eigen::Matrix2d::Identity()}, config);
    track.extent.footprint().heading_rad = 0.0;
    track.extent.box()->heading_variance_rad2 = 0.01;
    predict(track, kPeriodS, config);
    EXPECT_TRUE(update(track, 27'000'000, observation, 1e-4 * Eigen::Matrix2d::Identity(), config));
    return track.extent.footprint().heading_rad;
  };
  EXPECT_GT(heading_after(0.01), 0.1);
  EXPECT_NEAR(heading_after(0.15), 0.0, 0.03);
}

}  // namespace
}  // namespace slammot::tracking
