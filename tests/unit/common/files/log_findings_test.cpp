#include "common/files/log_findings.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/files/live_plan.hpp"

namespace slammot::files {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

LogPlan sound_plan() {
  LogPlan plan;
  plan.odometry = OdometrySource::kLaserRecords;
  plan.figures = {.scans = 100,
                  .beams = 181,
                  .has_clock = true,
                  .scan_period_s = 0.1,
                  .longest_gap_s = 0.1,
                  .are_of_scans = true,
                  .echo_share = 0.9};
  return plan;
}

TEST(DescribeFindings, IsSilentAboutASoundLog) {
  EXPECT_THAT(describe_findings(sound_plan()), IsEmpty());
}

TEST(DescribeFindings, NamesScansThatTellNothing) {
  LogPlan plan = sound_plan();
  plan.figures.echo_share = 0.0;
  EXPECT_THAT(describe_findings(plan), ElementsAre(HasSubstr("no beam has an echo")));
  plan.figures.are_of_scans = false;
  EXPECT_THAT(describe_findings(plan), IsEmpty()) << "a scenario does not say";
  plan.figures.beams = 8;
  EXPECT_THAT(describe_findings(plan), ElementsAre(HasSubstr("scans of 8 beams")));
}

TEST(DescribeFindings, SaysWhatWasDoneToTheClock) {
  LogPlan plan = sound_plan();
  plan.times.fault = sensing::ClockFault::kCoarse;
  plan.times.quantum_s = 1.0;
  EXPECT_THAT(describe_findings(plan), ElementsAre(HasSubstr("rounded to 1 s")));
}

TEST(DescribeFindings, SaysThatReadingsReachBeyondTheStatedMaximum) {
  LogPlan plan = sound_plan();
  plan.scanners.push_back({.max_range_m = 60.0, .refuted_max_range_m = 8.0});
  EXPECT_THAT(describe_findings(plan),
              ElementsAre(HasSubstr("beyond the maximum range of 8 m that the log states")));
}

TEST(DescribeFindings, SaysThatAScannerLooksDownAndWhetherItSeesLittleElse) {
  LogPlan plan = sound_plan();
  plan.scanners.push_back({.floor = {.from = {6.0F},
                                     .distance_m = 6.7,
                                     .bearing_rad = -0.5,
                                     .share_of_views = 0.8,
                                     .share_of_beams = 0.7}});
  EXPECT_THAT(describe_findings(plan),
              ElementsAre("scanner looks down: beams meet the floor 6.7 m away, 29 degrees to the "
                          "right, in 80 % of the views: echoes there and beyond are left out"));
  plan.scanners.front().floor.share_of_beams = 0.1;
  EXPECT_THAT(describe_findings(plan), ElementsAre(HasSubstr("only 10 % of the beams")));
  plan.scanners.front().floor.bearing_rad = 0.002;
  EXPECT_THAT(describe_findings(plan), ElementsAre(HasSubstr("6.7 m away, straight ahead, in")));
  plan.recorded_odometry = plan.odometry;
  plan = as_live(plan);
  EXPECT_THAT(describe_findings(plan), ElementsAre(HasSubstr("taken for a wall")));
  EXPECT_THAT(likely_causes(plan), HasSubstr("looks down"));
}

TEST(DescribeFindings, SaysThatTheWayHasTheWrongSign) {
  LogPlan plan = sound_plan();
  plan.evidence.correction.position_turn_rad = 3.14159;
  EXPECT_THAT(describe_findings(plan),
              ElementsAre(HasSubstr("way by odometry has the wrong sign")));
}

TEST(DescribeFindings, SaysThatStampsOfOdometryAreNoisy) {
  LogPlan plan = sound_plan();
  plan.odometry_stamp_noise_s = 0.004;
  EXPECT_THAT(describe_findings(plan), ElementsAre(HasSubstr("odometry are noisy by 4.0 ms")));
}

TEST(DescribeFindings, SaysWhichNoiseOfStampsWasRemoved) {
  LogPlan plan = sound_plan();
  plan.times.fault = sensing::ClockFault::kNoisy;
  plan.times.noise_s = 0.005;
  EXPECT_THAT(describe_findings(plan), ElementsAre(HasSubstr("noisy by 5.0 ms")));
}

TEST(DescribeFindings, SaysEachCorrectionInALine) {
  LogPlan plan = sound_plan();
  plan.evidence.correction.range_unit_m = 1e-3;
  plan.evidence.correction.reverses_beams = true;
  EXPECT_THAT(describe_findings(plan),
              ElementsAre(HasSubstr("millimetres"), HasSubstr("clockwise")));
}

TEST(DescribeFindings, CountsScansWithoutAReading) {
  LogPlan plan = sound_plan();
  plan.figures.scans_without_readings = 14;
  EXPECT_THAT(describe_findings(plan), ElementsAre(HasSubstr("14 of 100 scans")));
}

TEST(ScansShowMotion, NotWhereFewBeamsHaveAnEchoAndPairsHardlyMatch) {
  LogPlan plan = sound_plan();
  EXPECT_TRUE(scans_show_motion(plan)) << "no pair was tried";
  plan.evidence = {.pairs = 60, .matched_share = 0.2};
  EXPECT_TRUE(scans_show_motion(plan)) << "far apart, but full of echoes";
  plan.figures.echo_share = 0.12;
  EXPECT_FALSE(scans_show_motion(plan));
  EXPECT_THAT(describe_findings(plan), ::testing::Contains(HasSubstr("it is believed")));
  plan.evidence.matched_share = 0.8;
  EXPECT_TRUE(scans_show_motion(plan));
}

TEST(LikelyCauses, NameWhatTheEvidenceLeavesOpen) {
  LogPlan plan = sound_plan();
  EXPECT_THAT(likely_causes(plan), HasSubstr("heading sign"));
  plan.evidence = {.pairs = 40, .matched_share = 0.3};
  EXPECT_THAT(likely_causes(plan), HasSubstr("range unit"));
  plan.odometry = OdometrySource::kNone;
  EXPECT_THAT(likely_causes(plan), HasSubstr("no odometry"));
}

}  // namespace
}  // namespace slammot::files
