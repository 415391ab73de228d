#include "common/files/odometry_findings.hpp"

#include <set>

#include <gtest/gtest.h>

namespace slammot::files {
namespace {

using sensing::OdometryConclusions;
using sensing::OdometryEpisode;
using sensing::OdometryFault;

constexpr std::int64_t kSecond_ns = 1'000'000'000;

/// A drive that began at 100 s, all of it with odometry.
OdometryConclusions believed() {
  OdometryConclusions odometry;
  odometry.first_stamp_ns = 100 * kSecond_ns;
  odometry.steps = odometry.with_odometry = 5000;
  return odometry;
}

OdometryEpisode episode(OdometryFault fault, int at_s, int duration_s) {
  OdometryEpisode episode;
  episode.fault = fault;
  episode.begin_ns = (100 + at_s) * kSecond_ns;
  episode.end_ns = episode.begin_ns + duration_s * kSecond_ns;
  episode.first_scan = static_cast<std::uint64_t>(10 * at_s);
  episode.scans = static_cast<std::uint64_t>(10 * duration_s);
  return episode;
}

TEST(DescribeOdometry, SaysThatThereIsNone) { EXPECT_EQ(describe_odometry({}, true), "none"); }

TEST(DescribeOdometry, SaysThatItIsBelieved) {
  EXPECT_EQ(describe_odometry(believed(), true), "believed");
}

TEST(DescribeOdometry, SaysHowFarItIsOffAndThatThisIsBelieved) {
  OdometryConclusions odometry = believed();
  odometry.total.turn = 1.0 / 1.04;
  EXPECT_EQ(describe_odometry(odometry, true), "turn rate 4 % high, believed");
}

TEST(DescribeOdometry, SaysSinceWhenItIsCorrectedAndWhenItWasNotBelieved) {
  OdometryConclusions odometry = believed();
  odometry.total.way = 1.0 / 0.7;
  odometry.recalibrations.push_back({141 * kSecond_ns, 410, odometry.total});
  odometry.episodes.push_back(episode(OdometryFault::kSlipped, 213, 12));
  EXPECT_EQ(describe_odometry(odometry, true),
            "way 30 % short, corrected since 41 s; slipped for 12 s at 213 s");
}

TEST(DescribeOdometry, CountsScansWhereNoTimeIsKnown) {
  OdometryConclusions odometry = believed();
  odometry.recalibrations.push_back({141 * kSecond_ns, 410, odometry.total});
  odometry.episodes.push_back(episode(OdometryFault::kFrozen, 213, 12));
  EXPECT_EQ(describe_odometry(odometry, false),
            "corrected since scan 410; frozen for 120 scans at scan 2130");
}

TEST(DescribeOdometry, NamesSignsUnitsBiasAndLateness) {
  OdometryConclusions odometry = believed();
  odometry.total = {.way = 0.001, .turn = -1.0, .turn_bias_radps = -0.02};
  odometry.stamp_offset_s = 0.3;
  EXPECT_EQ(describe_odometry(odometry, true),
            "way 1e+03 times too long, turn rate with the wrong sign, turns by 1.1 deg/s of its "
            "own, 0.30 s late, believed");
}

TEST(DescribeOdometry, SaysHowMuchOfItWasNotBelieved) {
  OdometryConclusions odometry = believed();
  odometry.disbelieved = 4500;
  EXPECT_EQ(describe_odometry(odometry, true), "not believed in 90 % of the steps");
}

TEST(DescribeOdometry, TellsTheLongestEpisodesInTheirOrderAndCountsTheRest) {
  OdometryConclusions odometry = believed();
  for (const int duration_s : {3, 9, 4, 20, 5})
    odometry.episodes.push_back(episode(
        OdometryFault::kShort, 10 * static_cast<int>(odometry.episodes.size()), duration_s));
  odometry.more_episodes = 2;
  EXPECT_EQ(describe_odometry(odometry, true),
            "believed; counted too little for 9 s at 10 s; counted too little for 20 s at 30 s; "
            "counted too little for 5 s at 40 s; 4 more times not believed");
}

TEST(DescribeOdometry, SaysHowFarItJumped) {
  OdometryConclusions odometry = believed();
  odometry.episodes.push_back(episode(OdometryFault::kJumped, 8, 0));
  odometry.episodes.back().way_by_wheels_m = 40.2;
  odometry.episodes.back().way_by_matches_m = 0.2;
  EXPECT_EQ(describe_odometry(odometry, true), "believed; jumped by 40 m at 8 s");
}

TEST(NameOfOdometryFault, IsAnotherOneForEach) {
  std::set<std::string> names;
  for (int fault = 0; fault <= static_cast<int>(OdometryFault::kRough); ++fault)
    names.insert(name_of(static_cast<OdometryFault>(fault)));
  EXPECT_EQ(names.size(), static_cast<std::size_t>(OdometryFault::kRough) + 1);
  EXPECT_EQ(names.count(""), 0U);
}

TEST(DescribeGyro, SaysForHowLongItWasUsed) {
  EXPECT_EQ(describe_gyro({.read_s = 350.0,
                           .used_s = 312.0,
                           .bias_is_known = true,
                           .bias_radps = 0.01,
                           .turn_ratio = 1.02}),
            "its turns replace those of the wheels for 312 of 350 s; bias 0.573 degrees a second");
}

TEST(DescribeGyro, SaysWhyItWasNotUsed) {
  const auto reason = [](bool bias_is_known, double turn_ratio) {
    return describe_gyro(
        {.read_s = 60.0, .bias_is_known = bias_is_known, .turn_ratio = turn_ratio});
  };
  EXPECT_NE(reason(true, 0.0).find("hardly turned"), std::string::npos);
  EXPECT_NE(reason(true, -1.0).find("against the wheels"), std::string::npos);
  EXPECT_NE(reason(false, 1.0).find("bias"), std::string::npos);
  EXPECT_NE(reason(true, 57.3).find("57.30 times"), std::string::npos);
}

}  // namespace
}  // namespace slammot::files
