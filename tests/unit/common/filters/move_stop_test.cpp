#include "common/filters/move_stop.hpp"

#include <cmath>
#include <random>

#include <gtest/gtest.h>
#include <Eigen/Cholesky>

#include "tests/support/matchers.hpp"

namespace slammot::filters {
namespace {

using Eigen::Matrix2d;
using Eigen::Vector2d;
using slammot::testing::MatrixNear;

constexpr double kPeriodS = 0.1;
constexpr double kSigmaM = 0.1;
constexpr double kMemoryS = 1.0;

/// A series of positions that go at a velocity, with white noise.
StationaryProcess series_at(const Vector2d& velocity_mps, int count, unsigned seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal(0.0, kSigmaM);
  StationaryProcess series;
  for (int i = 0; i < count; ++i) {
    const double x_m = normal(random);
    series = observed(series, i * kPeriodS * velocity_mps + Vector2d(x_m, normal(random)),
                      i == 0 ? 0.0 : kPeriodS, kMemoryS);
  }
  return series;
}

MotionState moving_at(double speed_mps, double sigma_mps, double position_sigma_m) {
  MotionState state;
  state.mean(2) = speed_mps;
  state.covariance.topLeftCorner<2, 2>() =
      position_sigma_m * position_sigma_m * Matrix2d::Identity();
  state.covariance.block<2, 2>(2, 2) = sigma_mps * sigma_mps * Matrix2d::Identity();
  state.covariance.block<2, 2>(4, 4) = Matrix2d::Identity();
  return state;
}

TEST(StationaryProcess, IsTheFadedMeanAndCovarianceOfAllMeasurements) {
  std::mt19937_64 random(3);
  std::normal_distribution<double> normal;
  std::vector<Vector2d> positions_m;
  StationaryProcess series;
  for (int i = 0; i < 25; ++i) {
    const double x_m = normal(random);
    positions_m.emplace_back(x_m, normal(random));
    series = observed(series, positions_m.back(), i == 0 ? 0.0 : kPeriodS, kMemoryS);
  }
  double weight = 0.0;
  double squares = 0.0;
  Vector2d mean_m = Vector2d::Zero();
  const auto weight_of = [](std::size_t i) {
    return std::exp(-kPeriodS * (24.0 - static_cast<double>(i)) / kMemoryS);
  };
  for (std::size_t i = 0; i < positions_m.size(); ++i)
    weight += weight_of(i), squares += weight_of(i) * weight_of(i),
        mean_m += weight_of(i) * positions_m[i];
  mean_m /= weight;
  Matrix2d scatter_m2 = Matrix2d::Zero();
  for (std::size_t i = 0; i < positions_m.size(); ++i)
    scatter_m2 += weight_of(i) * (positions_m[i] - mean_m) * (positions_m[i] - mean_m).transpose();
  EXPECT_THAT(series.mean_m, MatrixNear(mean_m, 1e-12));
  EXPECT_THAT(series.covariance_m2(),
              MatrixNear(Matrix2d(scatter_m2 / (weight - squares / weight)), 1e-12));
  EXPECT_NEAR(series.age_s, 2.4, 1e-12);
}

TEST(StationaryProcess, SaysHowFarItsMeanIsOffFromWhereSomethingStands) {
  double off_m2 = 0.0;
  double said_m2 = 0.0;
  constexpr unsigned kRuns = 400;
  for (unsigned run = 0; run < kRuns; ++run) {
    const StationaryProcess series = series_at(Vector2d::Zero(), 40, run);
    off_m2 += series.mean_m.squaredNorm() / kRuns;
    said_m2 += series.mean_covariance_m2().trace() / kRuns;
  }
  EXPECT_NEAR(off_m2, 2.0 * kSigmaM * kSigmaM / 20.0, 0.0002);  // as of twice the memory's
                                                                // measurements, white
  EXPECT_GT(said_m2, off_m2);        // what looks like a drift by chance counts as one:
  EXPECT_LT(said_m2, 6.0 * off_m2);  // never too sure, and still surer than any single measurement
}

TEST(StationaryProcess, TellsWhiteNoiseByTheFadedMeanOfSquaredSteps) {
  StationaryProcess series;
  double weight = 0.0;
  double squares_m2 = 0.0;
  for (int i = 0; i < 25; ++i) {
    const double x_m = 0.1 * (i % 2);
    series = observed(series, {x_m, 0.0}, i == 0 ? 0.0 : kPeriodS, kMemoryS);
    if (i == 0) continue;
    const double step_weight = std::exp(-kPeriodS * (24.0 - i) / kMemoryS);
    weight += step_weight;
    squares_m2 += step_weight * 0.5 * 0.1 * 0.1;
  }
  EXPECT_NEAR(series.step_weight, weight, 1e-9);
  EXPECT_NEAR(series.differences_m2(0, 0) / series.step_weight, squares_m2 / weight, 1e-9);
}

TEST(StationaryProcess, IsNoSurerForMoreMeasurementsOfSomethingThatMoves) {
  const Vector2d velocity_mps{1.0, 0.0};
  const double said_m2 = series_at(velocity_mps, 60, 1).mean_covariance_m2().trace();
  EXPECT_GT(said_m2, 0.8 * kMemoryS * kMemoryS);  // it lags by the speed times the memory
}

TEST(MinimumDetectionSpeed, IsSoManySigmasOfTheLeastKnownDirection) {
  MotionState state;
  state.covariance.block<2, 2>(2, 2) << 0.05, 0.03, 0.03, 0.05;  // eigenvalues 0.08 and 0.02
  EXPECT_NEAR(minimum_detection_speed_mps(state, 3.0), 3.0 * std::sqrt(0.08), 1e-12);
}

TEST(MoveStop, HoldsWhatIsFasterThanTheMinimumToMoveAtOnce) {
  MoveStop hypotheses;
  const MoveStopConfig config{kMemoryS, 3.0};
  for (int i = 0; i < 30; ++i)
    hypotheses =
        weigh(hypotheses, {moving_at(0.05, 0.2, 0.08), {0.02 * (i % 2), 0.0}, kPeriodS}, config);
  ASSERT_TRUE(hypotheses.stands);
  hypotheses = weigh(hypotheses, {moving_at(0.7, 0.2, 0.08), {0.1, 0.0}, kPeriodS}, config);
  EXPECT_FALSE(hypotheses.stands);
  EXPECT_EQ(hypotheses.series.weight, 0.0);
}

TEST(MoveStop, HoldsNothingToStandBeforeTheMemoryIsFull) {
  MoveStop hypotheses;
  for (int i = 0; i < 9; ++i)
    hypotheses = weigh(hypotheses, {moving_at(0.0, 0.2, 10.0), {0.02 * (i % 2), 0.0}, kPeriodS},
                       {kMemoryS, 3.0});
  EXPECT_FALSE(hypotheses.stands);
}

TEST(MoveStop, BelievesTheMoversEstimateUnlessItsOwnIsMoreCertain) {
  MoveStop hypotheses;
  for (int i = 0; i < 60; ++i)  // creeps below the minimum, and the mover knows well where it is
    hypotheses = weigh(hypotheses, {moving_at(0.4, 0.2, 0.05), {0.4 * kPeriodS * i, 0.0}, kPeriodS},
                       {kMemoryS, 3.0});
  EXPECT_FALSE(hypotheses.stands);
}

TEST(MoveStop, ShiftsWithTheReferencePoint) {
  const Vector2d shift_m{3.0, -2.0};
  MoveStop here{series_at(Vector2d::Zero(), 20, 4), true};
  const Vector2d before_m = here.series.mean_m;
  move_stop_shift(here, shift_m);
  EXPECT_THAT(here.series.mean_m, MatrixNear(Vector2d(before_m + shift_m), 1e-12));
  const StationaryProcess next = observed(here.series, before_m + shift_m, kPeriodS, kMemoryS);
  EXPECT_LT(next.mean_covariance_m2().trace(), 0.02);  // no step from where it was before the shift
}

TEST(MoveStop, EstimatesAsTheHypothesisThatHolds) {
  const MotionState moving = moving_at(0.1, 0.2, 0.08);
  MoveStop hypotheses{series_at(Vector2d::Zero(), 20, 4), false};
  EXPECT_EQ(estimate_of(hypotheses, moving).mean, moving.mean);
  hypotheses.stands = true;
  const MotionState standing = estimate_of(hypotheses, moving);
  EXPECT_EQ(standing.mean.tail<4>().norm(), 0.0);
  EXPECT_THAT(standing.mean.head<2>(), MatrixNear(hypotheses.series.mean_m, 1e-12));
  EXPECT_GT(standing.covariance.ldlt().vectorD().minCoeff(), 0.0);
}

}  // namespace
}  // namespace slammot::filters
