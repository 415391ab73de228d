#include "common/matching/odometry_lateness.hpp"

#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace slammot::matching {
namespace {

using geometry::Pose2;

/// A vehicle that weaves and changes its speed, ten scans a second.
Pose2 pose_at(double time_s) {
  const double heading_rad = 0.6 * std::sin(0.9 * time_s);
  return {3.0 * time_s + 1.5 * std::sin(0.5 * time_s), 2.0 * std::sin(0.4 * time_s), heading_rad};
}

struct Drive {
  std::vector<double> scan_times_s;
  std::vector<TimedPose> odometry;
  std::vector<ScanPairMotion> pairs;
};

Drive drive_with(double late_s, std::size_t pair_count = 40) {
  Drive drive;
  for (int i = 0; i < 600; ++i) {
    drive.scan_times_s.push_back(0.1 * i);
    drive.odometry.push_back({0.1 * i, pose_at(0.1 * i - late_s)});
  }
  for (std::size_t i = 0; i < pair_count; ++i) {
    const std::size_t first = 20 + i * 13;
    const std::size_t second = first + 4;
    const Pose2 motion = geometry::inverse(pose_at(0.1 * static_cast<double>(first))) *
                         pose_at(0.1 * static_cast<double>(second));
    drive.pairs.push_back({first, second, motion.heading_rad, motion.translation_m().norm()});
  }
  return drive;
}

double found_in(const Drive& drive, double turn_scale = 1.0) {
  return odometry_lateness_s(drive.pairs, drive.scan_times_s, drive.odometry, {1.0, turn_scale});
}

TEST(OdometryLateness, IsFoundByTheTurnsOfPairsOfScans) {
  EXPECT_NEAR(found_in(drive_with(0.3)), 0.3, 0.01);
  EXPECT_NEAR(found_in(drive_with(-0.2)), -0.2, 0.01);
}

TEST(OdometryLateness, IsFoundInOdometryThatComesAtOtherTimesThanScans) {
  Drive drive = drive_with(0.0);
  drive.odometry.clear();
  for (int i = 0; i < 1500; ++i)
    drive.odometry.push_back({0.04 * i + 0.013, pose_at(0.04 * i + 0.013 - 0.25)});
  EXPECT_NEAR(found_in(drive), 0.25, 0.01);
}

TEST(OdometryLateness, IsNoneForOdometryInTime) { EXPECT_EQ(found_in(drive_with(0.0)), 0.0); }

TEST(OdometryLateness, IsNotWhatMakesWheelsTurnTooMuch) {
  for (const double late_s : {0.0, 0.3}) {
    Drive drive = drive_with(late_s);
    for (TimedPose& wheels : drive.odometry) wheels.pose.heading_rad *= 1.4;
    EXPECT_NEAR(found_in(drive, 1.0 / 1.4), late_s, 0.01);
  }
}

TEST(OdometryLateness, TakesADelayForOneWhereItChangesTheRatioOfTurns) {
  EXPECT_NEAR(found_in(drive_with(0.3), 0.93), 0.3, 0.01);
  EXPECT_NEAR(found_in(drive_with(0.3), 0.0), 0.3, 0.01) << "no turns to compare";
}

TEST(OdometryLateness, IsLeftToLocalizationWhereItIsSmall) {
  EXPECT_EQ(found_in(drive_with(0.04)), 0.0);
}

TEST(OdometryLateness, IsNotConcludedFromAFewPairs) {
  EXPECT_EQ(found_in(drive_with(0.3, 8)), 0.0);
}

TEST(OdometryLateness, IsNotConcludedFromPairsThatMatchWrongly) {
  Drive drive = drive_with(0.0);
  for (std::size_t i = 0; i < drive.pairs.size(); i += 2) drive.pairs[i].turn_rad += 0.3;
  EXPECT_EQ(found_in(drive), 0.0);
}

/// A vehicle that drives straight on, with wheels that turn at random: other noise is read at each
/// delay, so that one of them fits best by far.
TEST(OdometryLateness, IsNotConcludedFromTurnsThatAreNoise) {
  constexpr double kNoise_rad = 0.05;  // of each step
  for (const unsigned seed : {1U, 2U, 3U, 4U, 5U, 6U, 7U, 8U}) {
    std::mt19937 random(seed);
    Drive drive = drive_with(0.0);
    double heading_rad = 0.0;
    for (std::size_t i = 0; i < drive.odometry.size(); ++i) {
      heading_rad += kNoise_rad * (static_cast<double>(random() % 2001) / 1000.0 - 1.0);
      drive.odometry[i].pose = {0.3 * static_cast<double>(i), 0.0, heading_rad};
    }
    for (ScanPairMotion& pair : drive.pairs) pair = {pair.first_scan, pair.second_scan, 0.0, 1.2};
    EXPECT_EQ(found_in(drive), 0.0) << "seed " << seed;
  }
}

TEST(OdometryLateness, IsNotSeenWhereTheVehicleTurnsAndDrivesEvenly) {
  Drive drive = drive_with(0.3);
  for (std::size_t i = 0; i < drive.odometry.size(); ++i)
    drive.odometry[i].pose = {0.2 * static_cast<double>(i), 0.0,
                              geometry::wrap_angle(0.02 * static_cast<double>(i))};
  for (ScanPairMotion& pair : drive.pairs) pair = {pair.first_scan, pair.second_scan, 0.08, 0.8};
  EXPECT_EQ(found_in(drive), 0.0);
}

}  // namespace
}  // namespace slammot::matching
