#include "services/localization/localization_monitor.hpp"

#include <gtest/gtest.h>

#include "tests/support/mapped_world.hpp"

namespace slammot::localization {
namespace {

using geometry::Pose2;
using slammot::testing::MappedWorld;
using Verdict = LocalizationMonitor::Verdict;

constexpr std::int64_t kPeriod_ns = 100'000'000;
constexpr double kUsualShare = 0.9;
const Pose2 kHere{};
const Pose2 kElsewhere{2.5, 1.0, 0.6};

class LocalizationMonitorTest : public ::testing::Test {
 protected:
  explicit LocalizationMonitorTest(
      const LocalizerConfig& config = MappedWorld::config_of_small_map())
      : monitor_(config) {}

  /// The next scan, made at the origin, is matched at a pose.
  Verdict see(const ScanMatch& match, StepSource source, bool have_wheels_leapt = false) {
    Step step;
    step.wheels.are_doubted = step.wheels.have_leapt = have_wheels_leapt;
    step.stamp_ns = stamp_ns_ += kPeriod_ns;
    step.duration_s = 0.1;
    step.source = source;
    step.after.covariance.setIdentity();
    step.after.covariance *= 1e-6;
    return monitor_.judge({match, step, kUsualShare, points_, room_.map()});
  }
  static ScanMatch believed_at(const Pose2& pose) {
    return {.odom_from_base = {pose, geometry::Matrix3::Identity()}, .is_believed = true};
  }
  static ScanMatch lost_match() { return {.odom_from_base = {}, .is_lost = true}; }

  MappedWorld room_{slammot::testing::room()};
  ScanPoints points_ = room_.points_at(kHere);
  LocalizationMonitor monitor_;
  std::int64_t stamp_ns_ = 0;
};

TEST_F(LocalizationMonitorTest, IsContentWithAMatchThatTheMapExplains) {
  for (const StepSource source : {StepSource::kOdometry, StepSource::kVelocityAlone}) {
    EXPECT_EQ(see(believed_at(kHere), source), Verdict::kFits);
    EXPECT_TRUE(monitor_.confirm());
  }
  EXPECT_EQ(monitor_.trust(), PoseTrust::kConfirmed);
  EXPECT_EQ(monitor_.admission(), MapAdmission::kMapped);
}

TEST_F(LocalizationMonitorTest, TrustsOdometryOfAVehicleThatNobodyPicksUpForAsLongAsItTakes) {
  for (int scan = 0; scan < 100; ++scan)
    ASSERT_EQ(see(lost_match(), StepSource::kOdometry), Verdict::kDoesNotFit);
  EXPECT_FALSE(monitor_.is_lost());
  EXPECT_EQ(monitor_.trust(), PoseTrust::kDoubted);
}

TEST_F(LocalizationMonitorTest, IsLostAtOnceWithoutOdometry) {
  EXPECT_EQ(see(lost_match(), StepSource::kVelocityAlone), Verdict::kLost);
  EXPECT_TRUE(monitor_.is_lost());
  EXPECT_EQ(monitor_.lost_scans(), 1);
  EXPECT_EQ(monitor_.admission(), MapAdmission::kWithheld);
}

TEST_F(LocalizationMonitorTest, IsLostWithoutOdometryWhereTheMatchContradictsTheMap) {
  see(believed_at(kHere), StepSource::kVelocityAlone);
  EXPECT_EQ(see(believed_at(kElsewhere), StepSource::kVelocityAlone), Verdict::kLost);
}

TEST_F(LocalizationMonitorTest, IsNotLostByAScanOfTooFewEchoes) {
  EXPECT_EQ(see({.odom_from_base = {}}, StepSource::kVelocityAlone), Verdict::kFits);
  EXPECT_FALSE(monitor_.is_lost());
}

TEST_F(LocalizationMonitorTest, ConfirmsOnlyAfterSeveralScansInARow) {
  see(lost_match(), StepSource::kVelocityAlone);
  int scans = 1;
  while (!monitor_.confirm()) ++scans;
  EXPECT_EQ(scans, LocalizationMonitor::kFoundScans + 1);
  EXPECT_FALSE(monitor_.is_lost());
  EXPECT_EQ(monitor_.trust(), PoseTrust::kConfirmed);
}

TEST_F(LocalizationMonitorTest, GivesTheMapUpAfterASearchInVain) {
  const LocalizerConfig config;
  const double given_up_s = config.recovery.lost_after_s + LocalizationMonitor::kAstrayAfterS;
  for (int scan = 0; scan < 20; ++scan) see(lost_match(), StepSource::kVelocityAlone);
  const std::int64_t lost_since_ns = *monitor_.state().lost_since_ns;
  EXPECT_FALSE(
      monitor_.has_gone_astray(lost_since_ns + static_cast<std::int64_t>(0.9 * given_up_s * 1e9)));
  EXPECT_TRUE(
      monitor_.has_gone_astray(lost_since_ns + static_cast<std::int64_t>(1.1 * given_up_s * 1e9)));
  monitor_.begin_map();
  EXPECT_FALSE(monitor_.is_lost());
  EXPECT_FALSE(
      monitor_.has_gone_astray(stamp_ns_ + static_cast<std::int64_t>(1.1 * given_up_s * 1e9)));
}

TEST_F(LocalizationMonitorTest, KnowsADriveThatBeginsElsewhereFromWheelsThatBeginAnew) {
  ScanMatch match = believed_at(kHere);
  match.matched_share = kUsualShare;
  EXPECT_EQ(see(match, StepSource::kReach, true), Verdict::kFits);
  EXPECT_FALSE(monitor_.begins_elsewhere()) << "the vehicle is where it was";
  match.matched_share = 0.4 * kUsualShare;
  see(match, StepSource::kReach, true);
  EXPECT_FALSE(monitor_.begins_elsewhere()) << "a worse scan there than usual";
  match = believed_at(kElsewhere);
  match.matched_share = 0.5 * kUsualShare;
  EXPECT_EQ(see(match, StepSource::kReach, true), Verdict::kLost);
  EXPECT_TRUE(monitor_.begins_elsewhere());
  see(match, StepSource::kReach);
  EXPECT_FALSE(monitor_.begins_elsewhere()) << "told by the scan of the leap alone";
}

TEST_F(LocalizationMonitorTest, LooksWithSeveralScansBeforeItGivesTheMapUp) {
  see(lost_match(), StepSource::kVelocityAlone);
  EXPECT_FALSE(monitor_.has_gone_astray(stamp_ns_ + 60'000'000'000))
      << "scans may come a minute apart";
}

TEST_F(LocalizationMonitorTest, JudgesFromAStateAsBefore) {
  const LocalizationMonitor::State before = monitor_.state();
  see(lost_match(), StepSource::kVelocityAlone);
  monitor_.set_state(before);
  EXPECT_FALSE(monitor_.is_lost());
}

/// A robot that people pick up.
class LocalizationMonitorOfARobot : public LocalizationMonitorTest {
 protected:
  static LocalizerConfig config() {
    LocalizerConfig config = MappedWorld::config_of_small_map();
    config.odometry.may_be_picked_up = true;
    return config;
  }
  LocalizationMonitorOfARobot() : LocalizationMonitorTest(config()) {}
};

TEST_F(LocalizationMonitorOfARobot, TrustsOdometryForAWhileAndIsLostThen) {
  const int patient_scans = static_cast<int>(config().recovery.lost_after_s * 10.0);
  for (int scan = 0; scan < patient_scans; ++scan)
    ASSERT_EQ(see(lost_match(), StepSource::kOdometry), Verdict::kDoesNotFit) << scan;
  EXPECT_EQ(see(lost_match(), StepSource::kOdometry), Verdict::kLost);
}

TEST_F(LocalizationMonitorOfARobot, LetsScansWaitThatContradictTheMap) {
  see(believed_at(kHere), StepSource::kOdometry);
  EXPECT_EQ(see(believed_at(kElsewhere), StepSource::kOdometry), Verdict::kDoesNotFit);
  EXPECT_EQ(monitor_.admission(), MapAdmission::kDoubted);
}

/// Dead reckoning goes on whatever scans say.
class LocalizationMonitorOff : public LocalizationMonitorTest {
 protected:
  static LocalizerConfig config() {
    LocalizerConfig config = MappedWorld::config_of_small_map();
    config.recovery.recovers = false;
    return config;
  }
  LocalizationMonitorOff() : LocalizationMonitorTest(config()) {}
};

TEST_F(LocalizationMonitorOff, NeverAsksForASearch) {
  EXPECT_EQ(see(lost_match(), StepSource::kVelocityAlone), Verdict::kDoesNotFit);
  EXPECT_EQ(monitor_.trust(), PoseTrust::kConfirmed);
}

}  // namespace
}  // namespace slammot::localization
