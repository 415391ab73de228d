#include "common/sensing/odometry_episodes.hpp"

#include <gtest/gtest.h>

namespace slammot::sensing {
namespace {

using geometry::Pose2;

constexpr std::int64_t kPeriod_ns = 100'000'000;
constexpr double kPeriod_s = 0.1;

class OdometryEpisodesTest : public ::testing::Test {
 protected:
  OdometryEpisodesTest() { episodes_.begin(0); }

  /// So many steps as wheels and as matches have them.
  void drive(int steps, const std::optional<Pose2>& by_wheels, const Pose2& by_matches,
             StepExplanation explanation = StepExplanation::kWheels) {
    for (int i = 0; i < steps; ++i) {
      stamp_ns_ += kPeriod_ns;
      episodes_.observe({.stamp_ns = stamp_ns_,
                         .duration_s = kPeriod_s,
                         .by_wheels = by_wheels,
                         .by_matches = by_matches,
                         .explanation = explanation},
                        factors_);
    }
  }
  void drive_believed(int steps) { drive(steps, kStep, kStep); }
  void jump(double by_m) {
    stamp_ns_ += kPeriod_ns;
    episodes_.observe({.stamp_ns = stamp_ns_,
                       .duration_s = kPeriod_s,
                       .by_wheels = Pose2{by_m, 0.0, 0.0},
                       .by_matches = kStep,
                       .is_jump = true},
                      factors_);
  }

  OdometryConclusions concluded() const {
    return episodes_.conclusions(MotionCalibration::Zero(), 0.0);
  }

  /// The fault of a drive with a single episode, of 40 steps.
  OdometryFault fault_of(const Pose2& by_wheels, const Pose2& by_matches) {
    episodes_ = {};
    drive_believed(50);
    drive(40, by_wheels, by_matches, StepExplanation::kOther);
    drive_believed(50);
    const OdometryConclusions conclusions = concluded();
    EXPECT_EQ(conclusions.episodes.size(), 1U);
    return conclusions.episodes.empty() ? OdometryFault::kRough
                                        : conclusions.episodes.front().fault;
  }

  static constexpr Pose2 kStep{0.2, 0.0, 0.01};
  OdometryEpisodes episodes_;
  WheelFactors factors_;
  std::int64_t stamp_ns_ = 0;
};

TEST_F(OdometryEpisodesTest, AreNoneWhereOdometryIsBelieved) {
  drive_believed(300);
  EXPECT_TRUE(concluded().episodes.empty());
  EXPECT_EQ(concluded().steps, 300U);
  EXPECT_EQ(concluded().with_odometry, 300U);
  EXPECT_EQ(concluded().disbelieved, 0U);
}

TEST_F(OdometryEpisodesTest, HaveABeginningAnEndAndTheWayOfBoth) {
  drive_believed(100);
  drive(60, Pose2{}, kStep, StepExplanation::kOther);
  drive_believed(100);
  const OdometryConclusions conclusions = concluded();
  ASSERT_EQ(conclusions.episodes.size(), 1U);
  const OdometryEpisode& episode = conclusions.episodes.front();
  EXPECT_EQ(episode.fault, OdometryFault::kFrozen);
  EXPECT_EQ(episode.begin_ns, 100 * kPeriod_ns);
  EXPECT_NEAR(episode.duration_s(), 6.0, 1e-9);
  EXPECT_EQ(episode.first_scan, 100U);
  EXPECT_EQ(episode.scans, 60U);
  EXPECT_NEAR(episode.way_by_wheels_m, 0.0, 1e-9);
  EXPECT_NEAR(episode.way_by_matches_m, 12.0, 1e-9);
}

TEST_F(OdometryEpisodesTest, AreNamedByWhatOdometryAndScansSay) {
  EXPECT_EQ(fault_of({}, kStep), OdometryFault::kFrozen);
  EXPECT_EQ(fault_of(kStep, {}), OdometryFault::kMovedAlone);
  EXPECT_EQ(fault_of({0.0, 0.0, 0.02}, {}), OdometryFault::kMovedAlone);
  EXPECT_EQ(fault_of({-0.2, 0.0, 0.0}, {0.2, 0.0, 0.0}), OdometryFault::kWrongDirection);
  EXPECT_EQ(fault_of({0.2, 0.0, -0.03}, {0.2, 0.0, 0.03}), OdometryFault::kWrongTurn);
  EXPECT_EQ(fault_of({0.3, 0.0, 0.0}, {0.2, 0.0, 0.0}), OdometryFault::kSlipped);
  EXPECT_EQ(fault_of({0.1, 0.0, 0.0}, {0.2, 0.0, 0.0}), OdometryFault::kShort);
  EXPECT_EQ(fault_of({0.2, 0.0, 0.03}, {0.2, 0.0, 0.02}), OdometryFault::kMisturned);
  EXPECT_EQ(fault_of(kStep, kStep), OdometryFault::kRough);
}

TEST_F(OdometryEpisodesTest, GoOnOverAFewStepsThatAreBelieved) {
  drive_believed(50);
  for (int i = 0; i < 5; ++i) {
    drive(5, Pose2{}, kStep, StepExplanation::kOther);
    drive_believed(5);
  }
  drive_believed(50);
  ASSERT_EQ(concluded().episodes.size(), 1U);
  EXPECT_EQ(concluded().episodes.front().scans, 45U);
  EXPECT_EQ(concluded().disbelieved, 25U);
}

TEST_F(OdometryEpisodesTest, AreTwoWhereOdometryWasBelievedForAWhileBetween) {
  for (int i = 0; i < 2; ++i) {
    drive_believed(50);
    drive(10, Pose2{}, kStep, StepExplanation::kOther);
  }
  EXPECT_EQ(concluded().episodes.size(), 2U);
}

TEST_F(OdometryEpisodesTest, AreJumpsWhereOneStepIsImpossible) {
  drive_believed(50);
  jump(40.0);
  drive_believed(50);
  ASSERT_EQ(concluded().episodes.size(), 1U);
  EXPECT_EQ(concluded().episodes.front().fault, OdometryFault::kJumped);
  EXPECT_NEAR(concluded().episodes.front().way_by_wheels_m, 40.0, 1e-9);
}

TEST_F(OdometryEpisodesTest, AreGapsWhereOdometryIsSilent) {
  drive_believed(50);
  drive(60, std::nullopt, kStep, StepExplanation::kOther);
  drive_believed(50);
  ASSERT_EQ(concluded().episodes.size(), 1U);
  EXPECT_EQ(concluded().episodes.front().fault, OdometryFault::kMissing);
  EXPECT_EQ(concluded().disbelieved, 0U);
}

TEST_F(OdometryEpisodesTest, AreNoneWithoutAnyOdometry) {
  drive(60, std::nullopt, kStep, StepExplanation::kOther);
  EXPECT_TRUE(concluded().episodes.empty());
  EXPECT_EQ(concluded().with_odometry, 0U);
}

TEST_F(OdometryEpisodesTest, AreNotMadeOfAFewRoughSteps) {
  for (int i = 0; i < 5; ++i) {
    drive_believed(50);
    drive(2, kStep, kStep, StepExplanation::kRoughWheels);
  }
  EXPECT_TRUE(concluded().episodes.empty());
}

TEST_F(OdometryEpisodesTest, AreBoundedInNumber) {
  for (int i = 0; i < 70; ++i) {
    drive_believed(40);
    drive(5, Pose2{}, kStep, StepExplanation::kOther);
  }
  drive_believed(40);
  EXPECT_EQ(concluded().episodes.size(), OdometryEpisodes::kMostEpisodes);
  EXPECT_EQ(concluded().more_episodes, 70U - OdometryEpisodes::kMostEpisodes);
}

TEST_F(OdometryEpisodesTest, CountAScanOnceThatIsMatchedAgain) {
  drive_believed(10);
  stamp_ns_ -= kPeriod_ns;
  drive(1, Pose2{}, kStep, StepExplanation::kOther);
  EXPECT_EQ(concluded().steps, 10U);
  EXPECT_EQ(concluded().disbelieved, 1U);
}

TEST_F(OdometryEpisodesTest, KnowSinceWhenFactorsAreApplied) {
  drive_believed(30);
  factors_ = {.way = 0.77, .turn = 1.02};
  drive_believed(30);
  MotionCalibration calibration = MotionCalibration::Zero();
  calibration.x() = 0.01;
  const OdometryConclusions conclusions = episodes_.conclusions(calibration, 0.05);
  ASSERT_EQ(conclusions.recalibrations.size(), 1U);
  EXPECT_EQ(conclusions.recalibrations.front().stamp_ns, 31 * kPeriod_ns);
  EXPECT_NEAR(conclusions.total.way, 0.77 * 1.01, 1e-9);
  EXPECT_NEAR(conclusions.total.turn, 1.02, 1e-9);
  EXPECT_EQ(conclusions.stamp_offset_s, 0.05);
}

}  // namespace
}  // namespace slammot::sensing
