#include "common/sensing/pose_smoother.hpp"

#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/matchers.hpp"

namespace slammot::sensing {
namespace {

using geometry::Pose2;
using testing::PoseNear;

constexpr double kPeriod_s = 1.0 / 37.5;

/// A car that brakes and turns, at a sample's time.
Pose2 pose_at(double time_s) {
  const double way_m = 12.0 * time_s - 1.5 * time_s * time_s;
  const double heading_rad = 0.2 * time_s;
  return {way_m * std::cos(0.5 * heading_rad), way_m * std::sin(0.5 * heading_rad), heading_rad};
}

std::vector<Odometry> drive(std::size_t samples) {
  std::vector<Odometry> made;
  for (std::size_t i = 0; i < samples; ++i) {
    const double time_s = kPeriod_s * static_cast<double>(i);
    made.push_back({static_cast<std::int64_t>(std::llround(1e9 * time_s)), pose_at(time_s)});
  }
  return made;
}

std::vector<Odometry> smoothed(const std::vector<Odometry>& samples, std::size_t reach = 9) {
  PoseSmoother smoother(reach);
  std::vector<Odometry> all;
  for (const Odometry& sample : samples)
    if (const auto one = smoother.add(sample)) all.push_back(*one);
  while (const auto one = smoother.finish()) all.push_back(*one);
  return all;
}

TEST(PoseSmoother, GivesEachSampleBackInOrder) {
  for (const std::size_t samples : {0U, 1U, 5U, 9U, 10U, 100U}) {
    const auto made = drive(samples);
    const auto all = smoothed(made);
    ASSERT_EQ(all.size(), samples);
    for (std::size_t i = 0; i < samples; ++i) EXPECT_EQ(all[i].stamp_ns, made[i].stamp_ns);
  }
}

TEST(PoseSmoother, LeavesASmoothMotionAsItIs) {
  const auto made = drive(100);
  const auto all = smoothed(made);
  for (std::size_t i = 0; i < all.size(); ++i)
    EXPECT_THAT(all[i].wheel_from_base, PoseNear(made[i].wheel_from_base, 0.002)) << i;
}

/// RMS of the error of the step from one sample to the next, where there are as many on either
/// side.
double step_error_m(const std::vector<Odometry>& samples) {
  constexpr std::size_t kEnds = 10;
  double squared_m2 = 0.0;
  for (std::size_t i = kEnds; i + kEnds < samples.size(); ++i) {
    const Pose2 step = inverse(samples[i - 1].wheel_from_base) * samples[i].wheel_from_base;
    const double time_s = kPeriod_s * static_cast<double>(i);
    const Pose2 true_step = inverse(pose_at(time_s - kPeriod_s)) * pose_at(time_s);
    squared_m2 += (step.translation_m() - true_step.translation_m()).squaredNorm();
  }
  return std::sqrt(squared_m2 / static_cast<double>(samples.size() - 2 * kEnds));
}

TEST(PoseSmoother, TakesNoiseAndRoundingOutOfSteps) {
  std::mt19937 random(3);
  std::normal_distribution<double> noise_m(0.0, 0.01);
  auto noisy = drive(200);
  auto rounded = noisy;
  for (Odometry& sample : noisy) {
    sample.wheel_from_base.x_m += noise_m(random);
    sample.wheel_from_base.y_m += noise_m(random);
  }
  for (Odometry& sample : rounded) {
    sample.wheel_from_base.x_m = 0.02 * std::round(sample.wheel_from_base.x_m / 0.02);
    sample.wheel_from_base.y_m = 0.02 * std::round(sample.wheel_from_base.y_m / 0.02);
  }
  EXPECT_LT(step_error_m(smoothed(noisy)), 0.1 * step_error_m(noisy));
  EXPECT_LT(step_error_m(smoothed(rounded)), 0.2 * step_error_m(rounded));
}

TEST(PoseSmoother, DoesNotMixWhatLiesBeyondAJumpOrAGap) {
  const Pose2 jump{30.0, 4.0, 1.5};
  auto made = drive(60);
  for (std::size_t i = 30; i < made.size(); ++i) {
    made[i].wheel_from_base = jump * made[i].wheel_from_base;
    made[i].stamp_ns += 2'000'000'000;
  }
  const auto all = smoothed(made);
  for (std::size_t i = 0; i < all.size(); ++i)
    EXPECT_THAT(all[i].wheel_from_base, PoseNear(made[i].wheel_from_base, 0.002)) << i;
}

}  // namespace
}  // namespace slammot::sensing
