#include "common/filters/gpb.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "tests/support/maneuvers.hpp"
#include "tests/support/matchers.hpp"

namespace slammot::filters {
namespace {

using slammot::testing::kManeuverPeriodS;
using slammot::testing::maneuver_noise_m2;
using slammot::testing::MatrixNear;
using slammot::testing::measured;
using slammot::testing::start_of;
using slammot::testing::velocity_and_acceleration;

PositionFix fix_at(const Eigen::Vector2d& position_m) {
  return {kManeuverPeriodS, position_m, maneuver_noise_m2()};
}

/// RMS errors over many runs.
struct Errors {
  double position_m = 0.0;
  double velocity_mps = 0.0;
};

template <class State, class Step, class Combine>
Errors errors_of(const testing::Maneuver& truth_at, const State& start, const Step& step,
                 const Combine& combine) {
  constexpr unsigned kRuns = 40;
  constexpr int kScans = 130;
  constexpr int kSettled = 10;
  Errors sum;
  for (unsigned run = 0; run < kRuns; ++run) {
    const auto positions_m = measured(truth_at, kScans, 1000 + run);
    State state = start;
    for (int scan = 0; scan < kScans; ++scan) {
      state = step(state, fix_at(positions_m[static_cast<std::size_t>(scan)]));
      if (scan < kSettled) continue;
      const Vector6 error = combine(state).mean - truth_at((scan + 1) * kManeuverPeriodS);
      sum.position_m += error.head<2>().squaredNorm();
      sum.velocity_mps += error.segment<2>(2).squaredNorm();
    }
  }
  constexpr double kSamples = kRuns * (kScans - kSettled);
  return {std::sqrt(sum.position_m / kSamples), std::sqrt(sum.velocity_mps / kSamples)};
}

Errors errors_of_gpb1(const testing::Maneuver& truth_at) {
  const ModelSet set = velocity_and_acceleration();
  return errors_of(
      truth_at, gpb1_start(set, start_of(truth_at)),
      [&](const Gpb1State& state, const PositionFix& fix) { return gpb1_step(set, state, fix); },
      [](const Gpb1State& state) { return state.estimate; });
}

Errors errors_of_gpb2(const testing::Maneuver& truth_at) {
  const ModelSet set = velocity_and_acceleration();
  return errors_of(
      truth_at, imm_start(set, start_of(truth_at)),
      [&](const ImmState& state, const PositionFix& fix) { return gpb2_step(set, state, fix); },
      [&](const ImmState& state) { return imm_combine(set, state); });
}

Errors errors_of_imm(const testing::Maneuver& truth_at) {
  const ModelSet set = velocity_and_acceleration();
  return errors_of(
      truth_at, imm_start(set, start_of(truth_at)),
      [&](const ImmState& state, const PositionFix& fix) {
        return imm_update(set, imm_predict(set, state, fix.after_s), fix.position_m, fix.R)
            .posterior;
      },
      [&](const ImmState& state) { return imm_combine(set, state); });
}

TEST(Gpb, OfSecondOrderFollowsManeuversAsTheImmAndBothBetterThanOfFirst) {
  using testing::Maneuver;
  for (const Maneuver& maneuver :
       {Maneuver(testing::accelerating), Maneuver(testing::cruising), Maneuver(testing::turning),
        Maneuver(testing::moving_stopping_moving)}) {
    const Errors gpb1 = errors_of_gpb1(maneuver);
    const Errors gpb2 = errors_of_gpb2(maneuver);
    const Errors imm = errors_of_imm(maneuver);
    EXPECT_LT(imm.velocity_mps, 0.9 * gpb1.velocity_mps);
    EXPECT_LT(imm.position_m, gpb1.position_m);
    EXPECT_NEAR(imm.velocity_mps / gpb2.velocity_mps, 1.0, 0.05);
    EXPECT_NEAR(imm.position_m / gpb2.position_m, 1.0, 0.05);
  }
}

TEST(Gpb, OfEitherOrderIsAKalmanFilterWhenThereIsOneModel) {
  ModelSet set;
  set.models[0] = {MotionKind::kConstantAcceleration, 0.5, 0.0};
  set.size = 1;
  const MotionState start = start_of(testing::accelerating);
  const PositionFix fix = fix_at({0.4, -0.2});
  const MotionState expected =
      update_with_position(predict(set.models[0], start, fix.after_s), fix.position_m, fix.R)
          .posterior;
  const Gpb1State first = gpb1_step(set, gpb1_start(set, start), fix);
  const MotionState second = imm_combine(set, gpb2_step(set, imm_start(set, start), fix));
  EXPECT_THAT(first.estimate.mean, MatrixNear(expected.mean, 1e-12));
  EXPECT_THAT(first.estimate.covariance, MatrixNear(expected.covariance, 1e-12));
  EXPECT_THAT(second.mean, MatrixNear(expected.mean, 1e-12));
  EXPECT_THAT(second.covariance, MatrixNear(expected.covariance, 1e-12));
}

/// Both estimates after each of 60 noisy scans of a turn, the third and every further seventh
/// missing.
template <class Compare>
void for_each_scan_of_a_turn(const ModelSet& set, const Compare& compare) {
  const auto positions_m = measured(testing::turning, 60, 7);
  ImmState mixture = imm_start(set, start_of(testing::turning));
  double after_s = 0.0;
  for (std::size_t scan = 0; scan < positions_m.size(); ++scan) {
    after_s += kManeuverPeriodS;
    if (scan % 7 == 2) continue;
    mixture =
        imm_update(set, imm_predict(set, mixture, after_s), positions_m[scan], maneuver_noise_m2())
            .posterior;
    compare(mixture, PositionFix{after_s, positions_m[scan], maneuver_noise_m2()});
    after_s = 0.0;
  }
}

TEST(Gpb, OfFirstOrderIsPredictionAndUpdateOfAMixtureThatIsOneEstimate) {
  ModelSet set = velocity_and_acceleration();
  set.mixture = Mixture::kGpb1;
  Gpb1State whole = gpb1_start(set, start_of(testing::turning));
  for_each_scan_of_a_turn(set, [&](const ImmState& mixture, const PositionFix& fix) {
    whole = gpb1_step(set, whole, fix);
    EXPECT_THAT(imm_combine(set, mixture).mean, MatrixNear(whole.estimate.mean, 1e-8));
    EXPECT_THAT(imm_combine(set, mixture).covariance, MatrixNear(whole.estimate.covariance, 1e-8));
    EXPECT_NEAR(mixture.probability[1], whole.probability[1], 1e-10);
  });
}

TEST(Gpb, OfSecondOrderIsPredictionAndUpdateOfAMixtureOfPairs) {
  ModelSet set = velocity_and_acceleration();
  set.mixture = Mixture::kGpb2;
  ImmState whole = imm_start(set, start_of(testing::turning));
  for_each_scan_of_a_turn(set, [&](const ImmState& mixture, const PositionFix& fix) {
    whole = gpb2_step(set, whole, fix);
    EXPECT_THAT(mixture.modes[0].mean, MatrixNear(whole.modes[0].mean, 1e-8));
    EXPECT_THAT(mixture.modes[1].covariance, MatrixNear(whole.modes[1].covariance, 1e-8));
    EXPECT_NEAR(mixture.probability[1], whole.probability[1], 1e-10);
    EXPECT_TRUE(mixture.pairs.empty());
  });
}

TEST(Gpb, OfSecondOrderMovesAllPairsWithTheReferencePoint) {
  ModelSet set = velocity_and_acceleration();
  set.mixture = Mixture::kGpb2;
  const Eigen::Vector2d shift_m{3.0, -2.0};
  const Eigen::Vector2d measured_m{0.8, 0.1};
  ImmState still = imm_predict(set, imm_start(set, start_of(testing::cruising)), kManeuverPeriodS);
  ImmState shifted = still;
  imm_shift(set, shifted, shift_m);
  const ImmState there = imm_update(set, still, measured_m, maneuver_noise_m2()).posterior;
  const ImmState here =
      imm_update(set, shifted, measured_m + shift_m, maneuver_noise_m2()).posterior;
  EXPECT_THAT((imm_combine(set, here).mean - imm_combine(set, there).mean).head<2>().eval(),
              MatrixNear(shift_m, 1e-9));
  EXPECT_NEAR(here.probability[0], there.probability[0], 1e-12);
}

TEST(Gpb, OfBothOrdersAreTheSameWhileAllModelsHaveTheSamePast) {
  const ModelSet set = velocity_and_acceleration();
  const MotionState start = start_of(testing::cruising);
  const PositionFix fix = fix_at({1.4, 0.1});
  const Gpb1State first = gpb1_step(set, gpb1_start(set, start), fix);
  const ImmState second = gpb2_step(set, imm_start(set, start), fix);
  EXPECT_THAT(first.estimate.mean, MatrixNear(imm_combine(set, second).mean, 1e-9));
  EXPECT_THAT(first.estimate.covariance, MatrixNear(imm_combine(set, second).covariance, 1e-9));
  EXPECT_NEAR(first.probability[0], second.probability[0], 1e-12);
}

}  // namespace
}  // namespace slammot::filters
