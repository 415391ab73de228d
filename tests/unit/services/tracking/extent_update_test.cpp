#include "services/tracking/extent_update.hpp"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "services/tracking/confirmation.hpp"
#include "services/tracking/measurement_update.hpp"
#include "services/tracking/track_initiation.hpp"
#include "tests/support/example_tracks.hpp"

namespace slammot::tracking {
namespace {

using testing::known_walker;
using testing::kPeriodS;
using testing::out_from_behind_others;
using testing::see;

TEST(ExtentUpdate, LiesAlongWhatIsLongerThanAnyFront) {
  const TrackingConfig config;
  std::vector<Eigen::Vector2d> points;
  const auto flank_m = [&](double length_m) {
    points.clear();
    for (double y = 0.0; y < length_m; y += 0.2) points.emplace_back(20.0, y);
    Observation observation;
    observation.points_m = points;
    observation.beam_step_rad = 0.5 * M_PI / 180.0;
    observation.start = observation.end = Edge::kHidden;
    return observation;
  };
  Track track =
      initiated({{1}, 0, flank_m(2.0), 0.5 * M_PI, 1e-4 * Eigen::Matrix2d::Identity()}, config);
  ASSERT_LT(std::abs(std::sin(track.extent.footprint().heading_rad)), 0.1);  // as wide as the rear
                                                                             // of a car
  std::int64_t stamp_ns = 0;
  for (int scan = 0; scan < 20; ++scan) {
    predict(track, kPeriodS, config);
    ASSERT_TRUE(update(track, stamp_ns += 27'000'000, flank_m(3.1),
                       1e-4 * Eigen::Matrix2d::Identity(), config));
  }
  EXPECT_GT(std::abs(std::sin(track.extent.footprint().heading_rad)), 0.9);
}

TEST(ExtentUpdate, LiesAlongTheCourseWhereThatIsKnownToAQuarterRadian) {
  const TrackingConfig config;
  constexpr double kCourse_rad = 0.3;
  constexpr double kSpeed_mps = 4.0;
  std::vector<Eigen::Vector2d> rear_m;
  for (double y = -0.9; y < 0.95; y += 0.2) rear_m.emplace_back(20.0, y);
  Observation observation;
  observation.points_m = rear_m;
  observation.beam_step_rad = 0.5 * M_PI / 180.0;
  Track track = initiated({{1}, 0, observation, 0.0, 1e-4 * Eigen::Matrix2d::Identity()}, config);
  const auto heading_rad = [&](double course_variance_rad2) {
    restart_velocity(track.kinematics,
                     kSpeed_mps * Eigen::Vector2d(std::cos(kCourse_rad), std::sin(kCourse_rad)),
                     kSpeed_mps * std::sqrt(course_variance_rad2), config);
    return box_along_course(track, observation, config).heading_rad;
  };
  EXPECT_NEAR(heading_rad(0.04), kCourse_rad, 1e-9);
  EXPECT_GT(std::abs(std::sin(heading_rad(0.06) - kCourse_rad)), 0.1) << "by its shape";
}

TEST(ExtentUpdate, IsDrawnAnewWhereItWouldBeWiderThanAnythingThatGoesItsWay) {
  const TrackingConfig config;
  std::vector<Eigen::Vector2d> points;
  const auto bicycle_at = [&](double x_m) {
    points.clear();
    for (double x = 0.0; x < 1.7; x += 0.3) points.emplace_back(x_m + x, 8.0);
    Observation observation;
    observation.points_m = points;
    observation.beam_step_rad = 0.5 * M_PI / 180.0;
    return observation;
  };
  Track track =
      initiated({{1}, 0, bicycle_at(10.0), 0.0, 1e-4 * Eigen::Matrix2d::Identity()}, config);
  track.extent.footprint().heading_rad = 0.5 * M_PI;
  track.extent.box()->evidence.length.least_m = 4.1;  // once a parked car was taken for a part of
                                                      // it
  track.extent.box()->evidence.width.least_m = 1.7;
  *track.extent.box() = with_likely_sizes(*track.extent.box(), config);
  restart_velocity(track.kinematics, {5.5, 0.0}, 0.3, config);
  track.existence.confirmed = true;
  for (int scan = 1; scan < 10; ++scan) {
    predict(track, kPeriodS, config);
    update(track, scan * 27'000'000, bicycle_at(10.0 + 5.5 * kPeriodS * scan),
           1e-4 * Eigen::Matrix2d::Identity(), config);
  }
  EXPECT_LT(std::abs(std::sin(track.extent.footprint().heading_rad)), 0.1);
  EXPECT_LT(track.extent.footprint().length.value_m, 2.5);
  EXPECT_LT(track.extent.footprint().width.value_m, 1.0);
}

TEST(ExtentUpdate, OfOneKnownToWalkGetsNoSides) {
  const TrackingConfig config;
  Track track = known_walker(0.0, config);
  Track other = track;
  other.existence.hits = 10;
  see(track, {1.3 * kPeriodS, 8.0}, 1.5, config);
  see(other, {1.3 * kPeriodS, 8.0}, 1.5, config);
  EXPECT_EQ(track.extent.box(), nullptr);
  EXPECT_NE(other.extent.box(), nullptr) << "may be a part of something";
}

TEST(ExtentUpdate, OfWhichOnlyTheSidesAreWrongIsDrawnAnewAfterAWhile) {
  const TrackingConfig config;
  Track track = out_from_behind_others(config);
  track.extent.outline = Box();
  track.extent.footprint().heading_rad = 0.7;
  track.extent.footprint().length = {4.5, 0.1};
  track.extent.footprint().width = {1.8, 0.1};
  track.existence.consistency = {0.25, 0.6, 5.0};
  ASSERT_TRUE(misfits_only(track, config));
  const Eigen::Vector2d along = track.velocity_mps().normalized();
  std::vector<Eigen::Vector2d> points_m;
  for (int i = 0; i < 5; ++i)
    points_m.push_back(track.position_m() + (i - 2.0) * along);  // a flank
  Observation observation;
  observation.points_m = points_m;
  observation.beam_step_rad = 0.009;
  const double drawn_rad = track.extent.footprint().heading_rad;
  const auto see_for = [&](double time_s) {
    for (double s = 0.0; s < time_s; s += kPeriodS)
      reinitialise_extent_if_misfit(track, observation, kPeriodS, config);
  };
  see_for(0.1);
  EXPECT_EQ(track.extent.footprint().heading_rad, drawn_rad);
  observation.points_m = std::span(points_m).first(4);  // around fewer it would be drawn no better
  see_for(1.0);
  EXPECT_EQ(track.extent.footprint().heading_rad, drawn_rad);
  observation.points_m = points_m;
  see_for(kPeriodS);
  EXPECT_NEAR(
      std::abs(std::sin(track.extent.footprint().heading_rad - std::atan2(along.y(), along.x()))),
      0.0, 0.05);
}

}  // namespace
}  // namespace slammot::tracking
