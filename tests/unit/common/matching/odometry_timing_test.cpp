#include "common/matching/odometry_timing.hpp"

#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "common/matching/timing_pairs.hpp"
#include "tests/support/floor_plan.hpp"

namespace slammot::matching {
namespace {

using geometry::Pose2;
using geometry::Vector2;

constexpr int kScans = 1200;
constexpr double kPeriod_s = 0.03;
constexpr std::size_t kBeams = 181;
const AssumedBeams kForward{.first_beam_rad = -0.5 * std::numbers::pi,
                            .beam_step_rad = std::numbers::pi / (kBeams - 1),
                            .laser_in_base_m = {0.4, 0.0}};

/// To and fro in a hall: it weaves, and its speed changes.
Pose2 pose_at(double time_s) {
  const double heading_rad = 0.8 * std::sin(0.9 * time_s);
  return {10.0 + 6.0 * std::sin(0.35 * time_s), 8.0 + 3.0 * std::sin(0.61 * time_s), heading_rad};
}

testing::FloorPlan hall() {
  testing::FloorPlan plan;
  plan.add_box({0, 0}, {24, 16});
  plan.add_box({3, 2}, {4, 3});
  plan.add_box({18, 11}, {19.5, 13});
  plan.add_box({20, 4}, {21, 4.5});
  return plan;
}

std::vector<float> scan_from(const testing::FloorPlan& plan, const Pose2& map_from_base,
                             std::mt19937& random) {
  std::normal_distribution<double> noise_m(0.0, 0.02);
  const Pose2 laser = map_from_base * Pose2{0.4, 0.0, 0.0};
  std::vector<float> ranges;
  for (std::size_t i = 0; i < kBeams; ++i) {
    const double angle_rad = laser.heading_rad + kForward.first_beam_rad +
                             static_cast<double>(i) * kForward.beam_step_rad;
    double range_m = 0.0;
    plan.first_hit(laser.translation_m(), {std::cos(angle_rad), std::sin(angle_rad)}, range_m);
    ranges.push_back(static_cast<float>(range_m + noise_m(random)));
  }
  return ranges;
}

struct Log {
  TimingPairs pairs;
  std::vector<double> scan_times_s;
  std::vector<TimedPose> odometry;
};

Log log_with(double late_s, double way_factor = 1.0, double drift = 0.0, int scans = kScans) {
  const testing::FloorPlan plan = hall();
  std::mt19937 random(3);
  Log log;
  for (int i = 0; i < scans; ++i) {
    const double time_s = kPeriod_s * i;
    Pose2 recorded = pose_at(time_s - late_s - drift * time_s);
    recorded.x_m *= way_factor;
    recorded.y_m *= way_factor;
    log.scan_times_s.push_back(time_s);
    log.odometry.push_back({time_s, recorded});
    log.pairs.add(scan_from(plan, pose_at(time_s), random), recorded, static_cast<std::size_t>(i));
  }
  return log;
}

LogToTime to_time(const Log& log, const std::vector<ScanPair>& pairs, double around_s = 0.0) {
  return {pairs, kForward, 1.0, log.scan_times_s, log.odometry, around_s};
}

std::optional<OdometryTiming> timing_of(const Log& log, double around_s = 0.0) {
  const std::vector<ScanPair> pairs = log.pairs.pairs();
  const LogToTime timed = to_time(log, pairs, around_s);
  return odometry_timing(motions_by_scans(timed), timed);
}

TEST(OdometryTiming, IsFoundToSomeMilliseconds) {
  for (const double late_s : {-0.05, 0.0, 0.02, 0.1}) {
    const auto found = timing_of(log_with(late_s));
    ASSERT_TRUE(found) << late_s;
    EXPECT_LT(found->sigma_s, 0.005);
    EXPECT_NEAR(found->late_s, late_s, 0.006);
    EXPECT_NEAR(found->late_s, late_s, 4.0 * found->sigma_s);
  }
}

TEST(OdometryTiming, IsFoundAroundARoughOne) {
  const auto found = timing_of(log_with(0.4), 0.35);
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->late_s, 0.4, 0.006);
}

TEST(OdometryTiming, IsNotMovedByWheelsThatCountTooMuch) {
  const auto found = timing_of(log_with(0.03, 1.04));
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->late_s, 0.03, 0.008);
}

std::optional<OdometryDrift> drift_of(const Log& log) {
  const std::vector<ScanPair> pairs = log.pairs.pairs();
  const LogToTime timed = to_time(log, pairs);
  return odometry_drift(motions_by_scans(timed), timed);
}

TEST(OdometryDrift, IsFoundOfClocksThatDriftApart) {
  constexpr int kLong = 4 * kScans;
  constexpr double kDrift = 7e-4;  // 0.1 s over the log
  const auto found = drift_of(log_with(0.01, 1.0, kDrift, kLong));
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->drift, kDrift, 1e-4);
  EXPECT_NEAR(found->at_s, 0.5 * kPeriod_s * kLong, kPeriod_s);
  EXPECT_NEAR(found->late_s, 0.01 + kDrift * found->at_s, 0.006);
}

TEST(OdometryDrift, IsNoneOfALatenessThatStays) {
  EXPECT_FALSE(drift_of(log_with(0.05, 1.0, 0.0, 4 * kScans)));
  EXPECT_FALSE(drift_of(log_with(0.0, 1.03, 0.0, 4 * kScans)));
  EXPECT_FALSE(drift_of(log_with(0.05))) << "a short log";
}

TEST(OdometryTiming, IsNotToldByAVehicleThatDrivesEvenly) {
  const testing::FloorPlan plan = hall();
  std::mt19937 random(3);
  std::normal_distribution<double> noise_m(0.0, 5e-4);
  Log log;
  for (int i = 0; i < 300; ++i) {
    const double time_s = kPeriod_s * i;
    const Pose2 pose{6.0 + 1.2 * time_s, 8.0, 0.0};
    log.scan_times_s.push_back(time_s);
    log.odometry.push_back({time_s, {pose.x_m + noise_m(random), 8.0, 0.2 * noise_m(random)}});
    log.pairs.add(scan_from(plan, pose, random), log.odometry.back().pose,
                  static_cast<std::size_t>(i));
  }
  const auto found = timing_of(log);
  if (found) EXPECT_GT(found->sigma_s, 0.012);
}

TEST(OdometryTiming, IsUnknownOfAVehicleThatStands) {
  Log log = log_with(0.0);
  log.pairs = {};
  for (std::size_t i = 0; i < log.odometry.size(); ++i) {
    log.odometry[i].pose = pose_at(1.0);
    log.pairs.add(std::vector<float>(kBeams, 5.0F), pose_at(1.0), i);
  }
  EXPECT_FALSE(timing_of(log));
}

TEST(TimingPairs, AreWhereTheTurnRateChanges) {
  TimingPairs pairs;
  Pose2 pose;
  for (std::size_t i = 0; i < 2000; ++i) {
    // straight on, but for a curve
    pose = pose * Pose2{0.1, 0.0, i >= 1000 && i < 1050 ? 0.01 : 0.0};
    pairs.add({1.0F, 2.0F}, pose, i);
  }
  std::size_t about_the_curve = 0;
  for (const ScanPair& pair : pairs.pairs()) {
    EXPECT_LE((pair.second_recorded.translation_m() - pair.first_recorded.translation_m()).norm(),
              2.7);
    for (const std::size_t onset : {1000U, 1050U})
      about_the_curve += pair.first_scan < onset && onset < pair.second_scan ? 1 : 0;
  }
  EXPECT_GE(about_the_curve, 2U);
  EXPECT_LE(pairs.pairs().size(), 64U);
}

}  // namespace
}  // namespace slammot::matching
