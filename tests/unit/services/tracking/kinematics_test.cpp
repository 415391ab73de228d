#include "services/tracking/kinematics.hpp"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

namespace slammot::tracking {
namespace {

using Eigen::Matrix2d;
using Eigen::Vector2d;

const TrackingConfig kConfig;

/// At (10, 2) m with this velocity; one sigma of everything is 0.3.
Kinematics moving_at(const Vector2d& velocity_mps) {
  filters::MotionState state;
  state.mean << 10.0, 2.0, velocity_mps, 0.0, 0.0;
  state.covariance = 0.09 * filters::Matrix6::Identity();
  Kinematics kinematics;
  restart_from(kinematics, state, kConfig);
  return kinematics;
}

TEST(Kinematics, HasOneModeMoreWhereItMayTurnAndOneOnlyWhereItCruises) {
  Kinematics kinematics;
  EXPECT_EQ(models_of(kinematics, kConfig).size, 2U);
  kinematics.may_turn = true;
  EXPECT_EQ(models_of(kinematics, kConfig).size, 3U);
  EXPECT_EQ(models_of(kinematics, kConfig).models[2].kind, filters::MotionKind::kCoordinatedTurn);
  kinematics.may_turn = false;
  kinematics.cruises_only = true;
  EXPECT_EQ(models_of(kinematics, kConfig).size, 1U);
}

TEST(Kinematics, MixesAsTheSettingSays) {
  TrackingConfig config;
  EXPECT_EQ(motion_models(config).mixture, filters::Mixture::kImm);
  config.motion.mixture = filters::Mixture::kGpb2;
  Kinematics kinematics = moving_at({3.0, -1.0});
  predict(kinematics, 0.1, config);
  EXPECT_EQ(kinematics.mixture.pairs.size(), 4U);
}

TEST(Kinematics, GoesOnAtItsVelocityAndLessSurely) {
  Kinematics kinematics = moving_at({3.0, -1.0});
  const double before_m2 = kinematics.position_covariance_m2().trace();
  predict(kinematics, 0.5, kConfig);
  EXPECT_NEAR((kinematics.position_m() - Vector2d(11.5, 1.5)).norm(), 0.0, 1e-9);
  EXPECT_GT(kinematics.position_covariance_m2().trace(), before_m2);
}

TEST(Kinematics, ShiftedMovesItsPositionsAndNotItsVelocity) {
  Kinematics kinematics = moving_at({3.0, -1.0});
  kinematics.measured = MeasuredCentre{{10.1, 2.0}, Matrix2d::Identity()};
  const Kinematics before = kinematics;
  const Vector2d by_m{0.4, -0.7};
  shift(kinematics, by_m, kConfig);
  combine(kinematics, kConfig);
  EXPECT_NEAR((kinematics.position_m() - before.position_m() - by_m).norm(), 0.0, 1e-12);
  EXPECT_NEAR((kinematics.velocity_mps() - before.velocity_mps()).norm(), 0.0, 1e-12);
  EXPECT_NEAR((kinematics.measured->centre_m - before.measured->centre_m - by_m).norm(), 0.0,
              1e-12);
  EXPECT_EQ(kinematics.recentred_m, by_m);
}

TEST(Kinematics, IsTheSameInAShiftedWorld) {
  const Vector2d by_m{-20.0, 7.0};
  Kinematics here = moving_at({3.0, -1.0});
  Kinematics there = here;
  shift(there, by_m, kConfig);
  combine(there, kConfig);
  for (Kinematics* kinematics : {&here, &there}) predict(*kinematics, 0.3, kConfig);
  EXPECT_NEAR((there.position_m() - here.position_m() - by_m).norm(), 0.0, 1e-9);
  EXPECT_NEAR((there.estimate.covariance - here.estimate.covariance).norm(), 0.0, 1e-9);
}

TEST(Kinematics, RestartedKeepsItsPlace) {
  Kinematics kinematics = moving_at({3.0, -1.0});
  kinematics.may_turn = kinematics.cruises_only = true;
  restart_velocity(kinematics, {0.0, 5.0}, 0.2, kConfig);
  EXPECT_EQ(kinematics.position_m(), Vector2d(10.0, 2.0));
  EXPECT_EQ(kinematics.velocity_mps(), Vector2d(0.0, 5.0));
  EXPECT_NEAR(speed_sigma_mps(kinematics), 0.2, 1e-12);
  EXPECT_EQ(models_of(kinematics, kConfig).size, 2U);
}

TEST(Kinematics, HasTheCourseThatSamplesOfItsVelocityHave) {
  const Kinematics kinematics = moving_at({3.0, 4.0});
  std::mt19937 random(3);
  std::normal_distribution<double> normal(0.0, 0.3);
  const Course course = course_of(kinematics);
  double sum_rad = 0.0;
  double squares_rad2 = 0.0;
  constexpr int kSamples = 20'000;
  for (int i = 0; i < kSamples; ++i) {
    const double off_rad =
        std::atan2(4.0 + normal(random), 3.0 + normal(random)) - course.heading_rad;
    sum_rad += off_rad, squares_rad2 += off_rad * off_rad;
  }
  EXPECT_NEAR(sum_rad / kSamples, 0.0, 3.0 * std::sqrt(course.variance_rad2 / kSamples));
  EXPECT_NEAR(squares_rad2 / kSamples, course.variance_rad2, 0.05 * course.variance_rad2);
}

TEST(Kinematics, LosesTheVelocityAcrossTheAxisOfItsBoxAndKeepsThatAlongIt) {
  const auto constrained = [](bool is_measured_now) {
    Kinematics kinematics = moving_at({5.0, 1.0});
    constrain_to_axis(kinematics, {0.0, 0.0025, is_measured_now, 0.027}, kConfig);
    return kinematics.velocity_mps();
  };
  EXPECT_NEAR(constrained(true).x(), 5.0, 0.05);
  EXPECT_LT(constrained(true).y(), 0.85);
  EXPECT_GT(constrained(false).y(), constrained(true).y() + 0.02)
      << "the error of a remembered axis is common to many scans";
}

}  // namespace
}  // namespace slammot::tracking
