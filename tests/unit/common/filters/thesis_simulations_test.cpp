// The simulations of Wang 2004, Sections 4.3 to 4.6: what the text claims of Figures 4.2 to 4.18.
// The measurements' noise, speeds, acceleration and turn rate are the thesis'; it does not say the
// sampling period nor the noises of its models.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "common/filters/imm.hpp"
#include "common/filters/kalman.hpp"
#include "common/filters/move_stop.hpp"
#include "tests/support/maneuvers.hpp"

namespace slammot::filters {
namespace {

using Eigen::Matrix2d;
using Eigen::Vector2d;
using testing::kManeuverPeriodS;
using testing::kManeuverSigmaM;
using testing::Maneuver;

const MotionModel kCruise{MotionKind::kConstantVelocity, 0.05, 3.0};
const MotionModel kAccelerate{MotionKind::kConstantAcceleration, 20.0, 0.0};
const MotionModel kTurn{MotionKind::kCoordinatedTurn, 0.5, 0.0};

struct Sample {
  double time_s = 0.0;
  Vector6 truth = Vector6::Zero();
  MotionState moving;    ///< Of the IMM,
  MotionState estimate;  ///< and of the hypothesis that holds.
  ModelWeights probability = {};
  bool stands = false;

  double position_error_m() const { return (truth - moving.mean).head<2>().norm(); }
  double velocity_error_mps() const { return (truth - moving.mean).segment<2>(2).norm(); }
  double speed_mps() const { return moving.mean.segment<2>(2).norm(); }
};

ModelSet set_of(const std::vector<MotionModel>& models) {
  ModelSet set;
  for (const MotionModel& model : models) set.models[set.size++] = model;
  set.mean_stay_s = 2.0;
  return set;
}

/// Tracks a maneuver by the IMM and, beside it, by move-stop hypotheses.
std::vector<Sample> track(const std::vector<MotionModel>& models, const Maneuver& truth_at,
                          double duration_s, unsigned seed) {
  const ModelSet set = set_of(models);
  const MoveStopConfig config{1.0, 3.0};
  ImmState state = imm_start(set, testing::start_of(truth_at));
  MoveStop hypotheses;
  std::vector<Sample> samples;
  for (const Vector2d& position_m : testing::measured(
           truth_at, static_cast<int>(std::lround(duration_s / kManeuverPeriodS)), seed)) {
    state = imm_update(set, imm_predict(set, state, kManeuverPeriodS), position_m,
                       testing::maneuver_noise_m2())
                .posterior;
    Sample sample;
    sample.time_s = static_cast<double>(samples.size() + 1) * kManeuverPeriodS;
    sample.truth = truth_at(sample.time_s);
    sample.moving = imm_combine(set, state);
    sample.probability = state.probability;
    hypotheses = weigh(hypotheses, {sample.moving, position_m, kManeuverPeriodS}, config);
    sample.stands = hypotheses.stands;
    sample.estimate = estimate_of(hypotheses, sample.moving);
    samples.push_back(sample);
  }
  return samples;
}

/// Mean of a value over many runs' samples between two times.
template <class Value>
double mean_of(const std::vector<MotionModel>& models, const Maneuver& truth_at, double from_s,
               double until_s, const Value& value) {
  double sum = 0.0;
  double count = 0.0;
  for (unsigned seed = 1; seed <= 20; ++seed) {
    for (const Sample& sample : track(models, truth_at, until_s, seed)) {
      if (sample.time_s <= from_s) continue;
      sum += value(sample);
      count += 1.0;
    }
  }
  return sum / count;
}

double velocity_error_mps(const Sample& sample) { return sample.velocity_error_mps(); }
double position_error_m(const Sample& sample) { return sample.position_error_m(); }

/// The stop model simplified from constant velocity, Wang 2004, Eqs. (4.13)-(4.16), which the
/// thesis holds to be wrong.
Gaussian<2> track_by_stop_model(const std::vector<Vector2d>& positions_m) {
  Gaussian<2> state{positions_m.front(), testing::maneuver_noise_m2()};
  const double noise_mps = kManeuverSigmaM / kManeuverPeriodS;  // of the order of the measurements'
                                                                // noise
  const Matrix2d Q = std::pow(kManeuverPeriodS * noise_mps, 2) * Matrix2d::Identity();
  for (std::size_t i = 1; i < positions_m.size(); ++i)
    state = kalman_update<2, 2>(kalman_predict<2>(state, Matrix2d::Identity(), Q), positions_m[i],
                                Matrix2d::Identity(), testing::maneuver_noise_m2())
                .posterior;
  return state;
}

StationaryProcess track_by_stationary_process(const std::vector<Vector2d>& positions_m) {
  StationaryProcess series;
  for (const Vector2d& position_m : positions_m)
    series = observed(series, position_m, kManeuverPeriodS, 5.0);
  return series;
}

const std::vector<MotionModel> kCruiseOrAccelerate = {kCruise, kAccelerate};
constexpr unsigned kRuns = 20;

double probability_of_second(const Sample& sample) { return sample.probability[1]; }

TEST(ConstantAccelerationSimulation,
     IsFollowedByTheImmInWhichConstantAccelerationDominates) {  // Figures 4.2, 4.3
  EXPECT_LT(mean_of(kCruiseOrAccelerate, testing::accelerating, 2.0, 6.0, velocity_error_mps), 0.8);
  EXPECT_LT(mean_of(kCruiseOrAccelerate, testing::accelerating, 2.0, 6.0, position_error_m), 0.12);
  EXPECT_GT(mean_of(kCruiseOrAccelerate, testing::accelerating, 2.0, 6.0, probability_of_second),
            0.85);
}

// why Figure 4.2 needs both models
TEST(ConstantAccelerationSimulation, LeavesAFilterOfConstantVelocityBehind) {
  EXPECT_GT(mean_of({kCruise}, testing::accelerating, 2.0, 6.0, velocity_error_mps), 4.0);
  EXPECT_GT(mean_of({kCruise}, testing::accelerating, 2.0, 6.0, position_error_m), 1.0);
}

TEST(ConstantVelocitySimulation, IsStablyTrackedAfterASecond) {  // Figures 4.4, 4.5
  const double at_first_mps =
      mean_of(kCruiseOrAccelerate, testing::cruising, 0.0, 1.0, velocity_error_mps);
  const double settled_mps =
      mean_of(kCruiseOrAccelerate, testing::cruising, 2.0, 6.0, velocity_error_mps);
  EXPECT_GT(at_first_mps, 2.0 * settled_mps);
  EXPECT_LT(settled_mps, 0.25);
}

// Figure 4.5 against 4.3, by Section 4.5
TEST(ConstantVelocitySimulation, IsLessClearlyOneModelsThanConstantAcceleration) {
  const double when_accelerating =
      mean_of(kCruiseOrAccelerate, testing::accelerating, 2.0, 6.0, probability_of_second);
  const double when_cruising =
      1.0 - mean_of(kCruiseOrAccelerate, testing::cruising, 2.0, 6.0, probability_of_second);
  EXPECT_GT(when_cruising, 0.6);
  EXPECT_LT(when_cruising, when_accelerating);
}

TEST(ConstantVelocitySimulation, IsTrackedBestByTheSimplestModelThatDescribesIt) {  // Table 4.1
  const double simple_mps = mean_of({kCruise}, testing::cruising, 2.0, 6.0, velocity_error_mps);
  EXPECT_LT(2.0 * simple_mps,
            mean_of({kAccelerate}, testing::cruising, 2.0, 6.0, velocity_error_mps));
}

TEST(TurnSimulation, IsFollowedThoughNeitherModelTurns) {  // Figures 4.6, 4.7
  EXPECT_LT(mean_of(kCruiseOrAccelerate, testing::turning, 2.0, 10.0, velocity_error_mps), 0.7);
  EXPECT_LT(mean_of(kCruiseOrAccelerate, testing::turning, 2.0, 10.0, position_error_m), 0.12);
}

TEST(TurnSimulation, IsFollowedBetterByACoordinatedTurn) {  // as the text on Figure 4.7 says
  EXPECT_LT(mean_of({kCruise, kTurn}, testing::turning, 2.0, 10.0, velocity_error_mps),
            0.6 * mean_of(kCruiseOrAccelerate, testing::turning, 2.0, 10.0, velocity_error_mps));
  EXPECT_GT(mean_of({kCruise, kTurn}, testing::turning, 2.0, 10.0, probability_of_second), 0.8);
}

TEST(MoveStopMoveSimulation, IsFollowedByTheImmWhoseSpeedNeverComesToRest) {  // Figures 4.8, 4.9
  EXPECT_LT(
      mean_of(kCruiseOrAccelerate, testing::moving_stopping_moving, 1.0, 13.0, position_error_m),
      0.12);
  EXPECT_GT(
      mean_of(kCruiseOrAccelerate, testing::moving_stopping_moving, 6.0, 9.0, velocity_error_mps),
      0.1);
  for (unsigned seed = 1; seed <= kRuns; ++seed) {
    double fastest_mps = 0.0;
    for (const Sample& sample :
         track(kCruiseOrAccelerate, testing::moving_stopping_moving, testing::kStartsAtS, seed))
      if (sample.time_s > testing::kStandsAtS + 2.0)
        fastest_mps = std::max(fastest_mps, sample.speed_mps());
    EXPECT_GT(fastest_mps, 0.15) << seed;
  }
}

TEST(StationarySimulation, IsOvershotByAFilterOfConstantVelocity) {  // Figure 4.10
  EXPECT_GT(mean_of({kCruise}, testing::standing, 0.0, 1.0, velocity_error_mps), 0.2);
  const double still_off_m = mean_of({kCruise}, testing::standing, 4.0, 6.0, position_error_m);
  double process_off_m = 0.0;
  for (unsigned seed = 1; seed <= kRuns; ++seed)
    process_off_m +=
        track_by_stationary_process(testing::measured(testing::standing, 60, seed)).mean_m.norm() /
        kRuns;
  EXPECT_GT(still_off_m, 2.0 * process_off_m);
}

// Figures 4.11, 4.12
TEST(StationarySimulation, ConvergesWithTheStationaryProcessAndNotWithTheStopModel) {
  double stop_off_m2 = 0.0;
  double process_off_m2 = 0.0;
  for (unsigned seed = 1; seed <= kRuns; ++seed) {
    const auto positions_m = testing::measured(testing::standing, 60, seed);
    stop_off_m2 += track_by_stop_model(positions_m).mean.squaredNorm() / kRuns;
    const StationaryProcess process = track_by_stationary_process(positions_m);
    process_off_m2 += process.mean_m.squaredNorm() / kRuns;
    // represents the series
    EXPECT_NEAR(std::sqrt(0.5 * process.covariance_m2().trace()), kManeuverSigmaM, 0.03);
  }
  EXPECT_LT(process_off_m2, 0.1 * stop_off_m2);
}

TEST(ConstantVelocitySimulation,
     IsNoStationaryProcessWhateverTheStopModelSays) {  // Figures 4.13, 4.14
  const auto positions_m = testing::measured(testing::cruising, 20, 1);
  const Gaussian<2> stop = track_by_stop_model(positions_m);
  EXPECT_LT(std::sqrt(stop.covariance(0, 0)), kManeuverSigmaM);  // sure of itself,
  // and wrong: about the last two measurements' mean
  EXPECT_GT(std::abs(stop.mean.x() - testing::cruising(2.0).x()), 0.5);
  const StationaryProcess process = track_by_stationary_process(positions_m);
  EXPECT_GT(std::sqrt(process.covariance_m2()(0, 0)), 5.0);
  EXPECT_GT(std::sqrt(process.mean_covariance_m2()(0, 0)),
            std::abs(process.mean_m.x() - testing::cruising(2.0).x()) / 3.0);
}

TEST(MoveStopMoveSimulation, ComesToRestWithMoveStopHypotheses) {  // Figures 4.17, 4.18
  double moving_off_m = 0.0;
  double off_m = 0.0;
  int resting = 0;
  int samples = 0;
  for (unsigned seed = 1; seed <= kRuns; ++seed) {
    for (const Sample& sample :
         track(kCruiseOrAccelerate, testing::moving_stopping_moving, 13.0, seed)) {
      if (sample.truth(2) > 4.0) EXPECT_FALSE(sample.stands) << sample.time_s;
      if (sample.time_s <= testing::kStandsAtS + 2.5 || sample.time_s > testing::kStartsAtS)
        continue;
      ++samples;
      resting += sample.estimate.mean.segment<2>(2).isZero() ? 1 : 0;
      off_m += (sample.estimate.mean - sample.truth).head<2>().norm();
      moving_off_m += sample.position_error_m();
    }
  }
  EXPECT_GT(resting, 0.95 * samples);
  EXPECT_LT(off_m, 0.7 * moving_off_m);
}

}  // namespace
}  // namespace slammot::filters
