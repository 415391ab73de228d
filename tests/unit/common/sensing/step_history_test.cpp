#include "common/sensing/step_history.hpp"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "common/sensing/odometry_belief.hpp"

namespace slammot::sensing {
namespace {

using geometry::Matrix3;
using geometry::Pose2;
using geometry::UncertainPose2;

const UncertainPose2 kBefore{Pose2{5.0, -2.0, 1.0}, Matrix3::Zero()};
const Matrix3 kSure = 1e4 * Matrix3::Identity();

UncertainPose2 anywhere() {
  return {kBefore.pose, Eigen::Vector3d(1.0, 1.0, 0.6).cwiseAbs2().asDiagonal()};
}

double log_density(const StepHistory& history, const Pose2& step) {
  return history.log_marginal(kBefore, anywhere(), kBefore.pose * step, kSure);
}

/// A robot that logs a scan each metre and each half radian to the left.
StepHistory metres_and_left_turns() {
  StepHistory history;
  for (int i = 0; i < 10; ++i) {
    history.add({1.0 + 0.01 * (i % 3), 0.0, 0.01});
    history.add({0.0, 0.0, 0.5 + 0.01 * (i % 3)});
  }
  return history;
}

TEST(StepHistory, PrefersStepsThatWereMadeBefore) {
  const StepHistory history = metres_and_left_turns();
  EXPECT_GT(log_density(history, {1.0, 0.0, 0.0}), log_density(history, {0.0, 0.0, 0.0}) + 3.0)
      << "standing, which it never did";
  EXPECT_GT(log_density(history, {0.0, 0.0, 0.5}), log_density(history, {0.0, 0.0, 0.25}) + 1.0);
}

TEST(StepHistory, TakesTurnsToEitherSideForAlike) {
  const StepHistory history = metres_and_left_turns();
  EXPECT_NEAR(log_density(history, {0.0, 0.0, 0.5}), log_density(history, {0.0, 0.0, -0.5}), 1e-9);
}

TEST(StepHistory, LeavesAStepThatWasNeverMadeToTheWideDensity) {
  const StepHistory history = metres_and_left_turns();
  const double wide_alone = log_density(StepHistory{}, {-1.0, 0.5, 0.3});
  EXPECT_NEAR(log_density(history, {-1.0, 0.5, 0.3}), wide_alone + std::log(3.0 / 23.0), 0.05);
}

TEST(StepHistory, IsTheWideDensityBeforeTheFirstStep) {
  const Pose2 optimum = kBefore.pose * Pose2{0.4, 0.1, 0.2};
  EXPECT_DOUBLE_EQ(StepHistory{}.log_marginal(kBefore, anywhere(), optimum, kSure),
                   log_marginal_likelihood(anywhere(), optimum, kSure));
}

/// The density integrates to that of a scan which tells nothing: sums over a grid of optima agree
/// for any history.
TEST(StepHistory, IntegratesToTheSameForEveryHistory) {
  constexpr double kCell = 0.05;
  const auto mass = [](const StepHistory& history) {
    double sum = 0.0;
    for (double x = -4.0; x <= 4.0; x += kCell) {
      for (double y = -4.0; y <= 4.0; y += kCell) {
        for (double heading = -2.4; heading <= 2.4; heading += kCell) {
          sum += std::exp(history.log_marginal(
              {}, {Pose2{}, Eigen::Vector3d(0.8, 0.8, 0.5).cwiseAbs2().asDiagonal()},
              {x, y, heading}, 400.0 * Matrix3::Identity()));
        }
      }
    }
    return sum;
  };
  StepHistory history;
  history.add({1.0, 0.0, 0.0});
  history.add({0.2, 0.1, 0.4});
  const double expected = mass(StepHistory{});
  EXPECT_NEAR(mass(history) / expected, 1.0, 0.02);
}

TEST(StepHistory, ForgetsTheOldest) {
  StepHistory history = metres_and_left_turns();
  for (std::size_t i = 0; i < StepHistory::kKept; ++i) history.add({0.3, 0.0, 0.0});
  EXPECT_EQ(history.size(), StepHistory::kKept);
  EXPECT_LT(log_density(history, {0.0, 0.0, 0.5}), log_density(history, {0.3, 0.0, 0.0}) - 5.0);
}

TEST(StepHistory, KnowsADamagedOne) {
  StepHistory history = metres_and_left_turns();
  EXPECT_TRUE(history.is_sound());
  history.add({std::numeric_limits<double>::quiet_NaN(), 0.0, 0.0});
  EXPECT_FALSE(history.is_sound());
}

}  // namespace
}  // namespace slammot::sensing
