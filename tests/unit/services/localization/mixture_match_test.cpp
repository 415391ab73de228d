#include "services/localization/mixture_match.hpp"

#include <cmath>
#include <numbers>
#include <numeric>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/mapped_world.hpp"
#include "tests/support/matchers.hpp"

namespace slammot::localization {
namespace {

using geometry::Pose2;
using sensing::ExplanationWeights;
using sensing::StepExplanation;
using slammot::testing::MappedWorld;
using slammot::testing::PoseNear;

/// Scans are so far apart in time that each counts for much.
constexpr double kPeriod_s = 0.5;

Step step_to(const Pose2& odom_from_base, double sigma_m, double sigma_rad,
             StepExplanation explanation) {
  Step step;
  step.duration_s = step.usual_duration_s = kPeriod_s;
  step.source =
      explanation == StepExplanation::kOther ? StepSource::kVelocityAlone : StepSource::kOdometry;
  step.explanation = explanation;
  step.after.odom_from_base = odom_from_base;
  step.after.covariance.topLeftCorner<3, 3>() =
      Eigen::Vector3d(sigma_m * sigma_m, sigma_m * sigma_m, sigma_rad * sigma_rad).asDiagonal();
  return step;
}

/// Wheels to 1 cm, their tail to 4 cm, and constant velocity to 0.3 m.
StepMixture explanations_of(const Pose2& by_wheels, const Pose2& at_velocity) {
  return {step_to(by_wheels, 0.01, 0.003, StepExplanation::kWheels),
          step_to(by_wheels, 0.04, 0.012, StepExplanation::kRoughWheels),
          step_to(at_velocity, 0.3, 0.1, StepExplanation::kOther)};
}

double weight_of(const ExplainedStep& explained, StepExplanation explanation) {
  return explained.weights[sensing::index_of(explanation)];
}

class MixtureMatchTest : public ::testing::Test {
 protected:
  /// A scan at the pose under these predictions.
  ExplainedStep explain(const Pose2& truth, StepMixture steps, const MappedWorld& world) {
    return explain(world.scan_at(truth), std::move(steps), world);
  }

  ExplainedStep explain(const sensing::LaserScan& scan, StepMixture steps,
                        const MappedWorld& world) {
    ScanPoints points(config_);
    points.begin_scan();
    const auto take = [&](const Step& step) {
      points.deskew(scan, 0.0, 0.0);
      points.select(scan, step.after.odom_from_base, {});
    };
    take(steps.front());
    ScanMatcher matcher(config_);
    MixtureMatch mixture(config_);
    weights_ = sensing::predicted(weights_, config_.belief);
    ExplainedStep explained = mixture.explain(
        {std::move(steps), weights_, usual_share_, history_, points, world.map(), take}, matcher);
    weights_ = explained.weights;
    return explained;
  }

  LocalizerConfig config_ = MappedWorld::config_of_small_map();
  MappedWorld room_{slammot::testing::room()};
  ExplanationWeights weights_{1.0, 0.0, 0.0, 0.0};
  double usual_share_ = 0.9;
  sensing::StepHistory history_;
};

TEST_F(MixtureMatchTest, TakesWheelsThatTheScanAgreesWithWithoutASearch) {
  const Pose2 truth{0.3, 0.2, 0.1};
  const ExplainedStep explained =
      explain(truth, explanations_of({0.305, 0.196, 0.101}, {0.2, 0.1, 0.05}), room_);
  EXPECT_EQ(explained.step.explanation, StepExplanation::kWheels);
  EXPECT_EQ(explained.searches, 0U);
  EXPECT_GT(weight_of(explained, StepExplanation::kWheels), 0.9);
  EXPECT_THAT(explained.registered.map_from_base.pose, PoseNear(truth, 0.01));
}

TEST_F(MixtureMatchTest, FollowsTheScanWhereWheelsAreOffByManySigmas) {
  const Pose2 truth{0.3, 0.2, 0.1};
  StepMixture steps = explanations_of({0.9, 0.2, 0.1}, {0.15, 0.1, 0.05});
  steps.front().wheels.are_in_doubt = true;
  const ExplainedStep explained = explain(truth, steps, room_);
  EXPECT_EQ(explained.step.explanation, StepExplanation::kOther);
  EXPECT_LT(weight_of(explained, StepExplanation::kWheels), 0.01);
  EXPECT_THAT(explained.registered.map_from_base.pose, PoseNear(truth, 0.03));
}

TEST_F(MixtureMatchTest, KeepsWheelsInDoubtWhereTheScanTellsNothingOfTheWay) {
  const MappedWorld wall({{{-200.0, 3.0}, {200.0, 3.0}}});
  weights_ = {0.4, 0.0, 0.0, 0.6};
  StepMixture steps{step_to({0.7, 0.0, 0.0}, 0.01, 0.003, StepExplanation::kWheels),
                    step_to({0.7, 0.0, 0.0}, 0.04, 0.012, StepExplanation::kRoughWheels),
                    step_to({0.6, 0.0, 0.0}, 0.01, 0.003, StepExplanation::kOther)};
  for (Step& step : steps) step.after.covariance(0, 0) = 0.4;  // anywhere along the wall
  steps.front().wheels.are_in_doubt = true;
  steps.front().odom_from_base_before.covariance(0, 0) = 0.4;
  const ExplainedStep explained = explain({0.7, 0.0, 0.0}, steps, wall);
  EXPECT_NE(explained.step.explanation, StepExplanation::kOther);
}

TEST_F(MixtureMatchTest, TakesTheTailOfOdometryForErrorsOfAFewSigmasInARow) {
  const Pose2 truth{0.3, 0.2, 0.1};
  const StepMixture steps = explanations_of({0.36, 0.2, 0.1}, {-0.6, -0.6, -0.1});
  ExplainedStep explained = explain(truth, steps, room_);
  for (int scan = 1; scan < 6; ++scan) explained = explain(truth, steps, room_);
  EXPECT_EQ(explained.step.explanation, StepExplanation::kRoughWheels);
  EXPECT_THAT(explained.registered.map_from_base.pose, PoseNear(truth, 0.03));
}

TEST_F(MixtureMatchTest, PrefersRecalibratedWheelsThatPredictSurelyAndRight) {
  const Pose2 truth{0.3, 0.2, 0.1};
  StepMixture steps = explanations_of({0.5, 0.2, 0.1}, {0.1, 0.1, 0.05});
  steps.push_back(step_to({0.302, 0.199, 0.1}, 0.01, 0.003, StepExplanation::kRecalibrated));
  const ExplainedStep explained = explain(truth, steps, room_);
  EXPECT_EQ(explained.step.explanation, StepExplanation::kRecalibrated);
  EXPECT_THAT(explained.registered.map_from_base.pose, PoseNear(truth, 0.02));
}

TEST_F(MixtureMatchTest, LeavesTheWayAlongAWallToTheWheels) {
  const MappedWorld wall({{{-200.0, 3.0}, {200.0, 3.0}}});
  const Pose2 by_wheels{0.7, 0.0, 0.0};
  const ExplainedStep explained =
      explain({0.2, 0.0, 0.0}, explanations_of(by_wheels, {0.2, 0.0, 0.0}), wall);
  EXPECT_EQ(explained.step.explanation, StepExplanation::kWheels);
  EXPECT_NEAR(explained.registered.map_from_base.pose.x_m, by_wheels.x_m, 0.02);
  EXPECT_GT(weight_of(explained, StepExplanation::kWheels), 0.8)
      << "nothing was learned of the way";
}

TEST_F(MixtureMatchTest, BelievesWheelsAgainOnceScansAgreeForAWhile) {
  const Pose2 truth{0.3, 0.2, 0.1};
  explain(truth, explanations_of({0.9, 0.2, 0.1}, {0.2, 0.1, 0.05}), room_);
  int scans = 0;
  for (; weights_[sensing::index_of(StepExplanation::kWheels)] < 0.9 && scans < 20; ++scans)
    explain(truth, explanations_of(truth, truth), room_);
  EXPECT_LT(scans, 8);
}

TEST_F(MixtureMatchTest, LooksFartherWhereFewerPointsMatchThanUsual) {
  const Pose2 truth{0.3, 0.2, 0.1};
  const Pose2 by_wheels{1.6, 0.2, 0.3};  // so far off that little is paired
  StepMixture steps = explanations_of(by_wheels, {0.2, 0.1, 0.0});
  const ExplainedStep explained = explain(truth, steps, room_);
  EXPECT_GT(explained.searches, 0U);
  EXPECT_THAT(explained.registered.map_from_base.pose, PoseNear(truth, 0.03));
}

TEST_F(MixtureMatchTest, StaysWithWheelsWhereTheScanHardlyMatchesUnderAnyExplanation) {
  const MappedWorld bus(
      {{{1.5, -1.2}, {1.1, -0.4}}, {{1.1, -0.4}, {1.8, 0.3}}, {{1.8, 0.3}, {1.2, 1.2}}});
  const Pose2 by_wheels{0.3, 0.2, 0.1};
  const ExplainedStep explained =
      explain(bus.scan_at({0.0, 0.0, 0.0}), explanations_of(by_wheels, {0.9, 0.4, 0.3}), room_);
  EXPECT_EQ(explained.step.explanation, StepExplanation::kWheels);
  EXPECT_EQ(explained.step.after.odom_from_base, by_wheels);
  EXPECT_GT(weight_of(explained, StepExplanation::kWheels), 0.9)
      << "nothing is learned of odometry";
}

/// Anywhere about the last pose, and like a step before.
StepMixture steps_without_odometry(const Pose2& usual) {
  StepMixture steps{step_to({0.3, 0.0, 0.0}, 0.8, 0.3, StepExplanation::kOther),
                    step_to(usual, 0.15, 0.1, StepExplanation::kOther),
                    step_to(usual, 0.15, 0.1, StepExplanation::kOther)};
  for (Step& step : steps) step.source = StepSource::kReach;
  return steps;
}

MappedWorld corridor_with_stubs() {
  return MappedWorld{{{{-20.0, 1.5}, {20.0, 1.5}},
                      {{-20.0, -1.5}, {20.0, -1.5}},
                      {{3.0, 1.5}, {3.0, 0.75}},
                      {{-2.5, -1.5}, {-2.5, -1.2}}}};
}

TEST_F(MixtureMatchTest, WithoutOdometryAFewPointsOutweighAUsualStepAlongACorridor) {
  const MappedWorld corridor = corridor_with_stubs();
  const Pose2 usual{1.2, 0.0, 0.0};
  const Pose2 truth{0.2, 0.0, 0.0};
  for (std::size_t i = 0; i < sensing::StepHistory::kKept; ++i) history_.add(usual);
  usual_share_ = 1.0;
  weights_ = {0.0, 0.0, 0.0, 1.0};
  const ExplainedStep explained = explain(truth, steps_without_odometry(usual), corridor);
  EXPECT_THAT(explained.registered.map_from_base.pose, PoseNear(truth, 0.1));
}

TEST_F(MixtureMatchTest, WithoutOdometryLooksFartherWhereTheMapContradictsAUsualStep) {
  const MappedWorld corridor = corridor_with_stubs();
  const Pose2 usual{1.2, 0.0, 0.0};
  const Pose2 truth{0.2, 0.0, 0.0};
  for (std::size_t i = 0; i < sensing::StepHistory::kKept; ++i) history_.add(usual);
  weights_ = {0.0, 0.0, 0.0, 1.0};
  StepMixture only_usual{steps_without_odometry(usual)[1], steps_without_odometry(usual)[2]};
  const double share_there = explain(truth, only_usual, corridor).registered.matched_share;
  usual_share_ = share_there + 0.06;  // less than a scan's usual scatter
  const ExplainedStep explained = explain(truth, steps_without_odometry(usual), corridor);
  EXPECT_THAT(explained.registered.map_from_base.pose, PoseNear(truth, 0.1));
}

TEST_F(MixtureMatchTest, WithoutOdometryLooksForAnyStepUntilTheUsualShareIsKnown) {
  const MappedWorld corridor = corridor_with_stubs();
  const Pose2 usual{1.2, 0.0, 0.0};
  const Pose2 truth{0.2, 0.0, 0.0};
  history_.add(usual);
  usual_share_ = 0.5;  // as at the start of a drive
  weights_ = {0.0, 0.0, 0.0, 1.0};
  const ExplainedStep explained = explain(truth, steps_without_odometry(usual), corridor);
  EXPECT_THAT(explained.registered.map_from_base.pose, PoseNear(truth, 0.1));
}

/// A scanner that looks ahead by half a turn and 8 m far, in a corridor with a niche from 3 m
/// ahead of the origin on, and a pillar in each metre.
sensing::LaserScan scan_in_corridor(const Pose2& odom_from_base) {
  slammot::testing::World corridor{{{-40.0, -1.0}, {40.0, -1.0}}, {{-40.0, 1.0}, {3.0, 1.0}},
                                   {{3.0, 1.0}, {3.0, 2.5}},      {{3.0, 2.5}, {6.0, 2.5}},
                                   {{6.0, 2.5}, {6.0, 1.0}},      {{6.0, 1.0}, {40.0, 1.0}}};
  for (int x_m = -20; x_m < 20; ++x_m) corridor.push_back({{x_m + 0.3, -1.0}, {x_m + 0.3, -0.8}});
  sensing::LaserScan scan;
  scan.scanner.first_beam_rad = -0.5 * std::numbers::pi;
  scan.scanner.beam_step_rad = std::numbers::pi / 180.0;
  scan.scanner.max_range_m = 8.0;
  for (std::size_t beam = 0; beam < 181; ++beam)
    scan.range_m.push_back(static_cast<float>(slammot::testing::range_m(
        corridor, odom_from_base.translation_m(),
        odom_from_base.heading_rad + sensing::beam_angle_rad(scan.scanner, beam))));
  return scan;
}

/// What is matched of the scan.
void take(const sensing::LaserScan& scan, const Pose2& odom_from_base, ScanPoints& points) {
  points.deskew(scan, 0.0, 0.0);
  points.select(scan, odom_from_base, {});
}

TEST_F(MixtureMatchTest, BelievesWheelsThatBackAwayFromWhatTheScannerSees) {
  const Pose2 start{0.03, 0.02, 0.0};
  const Pose2 behind{-0.97, 0.02, 0.0};
  ScanPoints points(config_);
  points.begin_scan();
  take(scan_in_corridor(start), start, points);
  LocalMap map(config_.map, geometry::Vector2::Zero());
  std::vector<grids::Ray> rays;
  for (const matching::MatchPoint& point : points.matched())
    rays.push_back({start * point.in_base_m, grids::Echo::kStationary});
  map.integrate(0, start.translation_m(), rays, std::numbers::pi / 180.0);
  points.begin_scan();
  const sensing::LaserScan scan = scan_in_corridor(behind);
  StepMixture steps{step_to(behind, 0.01, 0.003, StepExplanation::kWheels),
                    step_to(behind, 0.04, 0.012, StepExplanation::kRoughWheels),
                    step_to(behind, 0.9, 0.1, StepExplanation::kOther)};
  for (Step& step : steps) {
    step.usual_duration_s = 2.0;  // a scan a metre
    step.odom_from_base_before.pose = start;
  }
  steps.front().wheels.are_in_doubt = true;
  take(scan, behind, points);
  ScanMatcher matcher(config_);
  MixtureMatch mixture(config_);
  const ExplainedStep explained =
      mixture.explain({steps, weights_, 0.9, history_, points, map,
                       [&](const Step& step) { take(scan, step.after.odom_from_base, points); }},
                      matcher);
  EXPECT_EQ(explained.step.explanation, StepExplanation::kWheels);
  EXPECT_NEAR(explained.registered.map_from_base.pose.x_m, behind.x_m, 0.1);
  EXPECT_GT(weight_of(explained, StepExplanation::kWheels), 0.5);
}

TEST_F(MixtureMatchTest, WeighsExplanationsToASumOfOne) {
  for (const double off_m : {0.0, 0.03, 0.1, 0.5, 2.0}) {
    const ExplainedStep explained =
        explain({0.3, 0.2, 0.1}, explanations_of({0.3 + off_m, 0.2, 0.1}, {0.2, 0.1, 0.0}), room_);
    EXPECT_NEAR(std::accumulate(explained.weights.begin(), explained.weights.end(), 0.0), 1.0, 1e-9)
        << off_m;
  }
}

}  // namespace
}  // namespace slammot::localization
