#include "services/localization/timing_scans.hpp"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

namespace slammot::localization {
namespace {

using geometry::Pose2;
using matching::MotionChange;

constexpr std::int64_t kPeriod_ns = 40'000'000;

struct Found {
  std::int64_t first_ns = 0;
  std::int64_t second_ns = 0;
  MotionChange change = MotionChange::kFaster;
};

/// Of a drive by the way and turn of each step.
template <typename StepAt>
std::vector<Found> pairs_of(int scans, StepAt step_at, TimingScans& timing) {
  std::vector<Found> found;
  Pose2 pose;
  for (int i = 0; i < scans; ++i) {
    pose = pose * step_at(i);
    timing.add(i * kPeriod_ns, pose, pose, {});
    if (const auto pair = timing.take())
      found.push_back({pair->first.stamp_ns, pair->second.stamp_ns, pair->change});
  }
  return found;
}

Pose2 with_a_curve(int scan) { return {0.2, 0.0, scan >= 300 && scan < 330 ? 0.02 : 0.0}; }

TEST(TimingScans, ArePairedWhereTheTurnRateChanges) {
  TimingScans timing;
  const std::vector<Found> found = pairs_of(600, with_a_curve, timing);
  std::size_t into = 0, out_of = 0;
  for (const Found& pair : found) {
    EXPECT_LE(pair.second_ns - pair.first_ns, 60 * kPeriod_ns);
    EXPECT_TRUE(matching::is_of_turn(pair.change));
    const auto holds = [&](int scan) {
      return pair.first_ns < scan * kPeriod_ns && scan * kPeriod_ns < pair.second_ns;
    };
    into += pair.change == MotionChange::kTurnsMore && holds(300) ? 1 : 0;
    out_of += pair.change == MotionChange::kTurnsLess && holds(330) ? 1 : 0;
  }
  EXPECT_EQ(into, 1U);
  EXPECT_EQ(out_of, 1U);
}

TEST(TimingScans, ArePairedWhereTheVehicleBrakesAndSetsOff) {
  TimingScans timing;
  const auto speeds = [](int scan) {
    const double share = scan < 200 ? 1.0 : scan < 250 ? (250 - scan) / 50.0 : 0.0;
    return Pose2{0.2 * share, 0.0, 0.0};
  };
  const std::vector<Found> found = pairs_of(500, speeds, timing);
  ASSERT_FALSE(found.empty());
  for (const Found& pair : found) EXPECT_EQ(pair.change, MotionChange::kSlower);
}

TEST(TimingScans, AreNotPairedOfAVehicleThatDrivesEvenlyOrStands) {
  TimingScans timing;
  EXPECT_TRUE(pairs_of(
                  400,
                  [](int) {
                    return Pose2{0.2, 0.0, 0.004};
                  },
                  timing)
                  .empty());
  EXPECT_TRUE(pairs_of(
                  400, [](int) { return Pose2{}; }, timing)
                  .empty());
}

TEST(TimingScans, OfOneChangeDoNotOverlap) {
  TimingScans timing;
  const auto weaves = [](int scan) { return Pose2{0.2, 0.0, 0.02 * std::sin(0.05 * scan)}; };
  std::vector<Found> latest(matching::kMotionChanges);
  std::size_t count = 0;
  for (const Found& pair : pairs_of(3000, weaves, timing)) {
    Found& before = latest[static_cast<std::size_t>(pair.change)];
    EXPECT_GE(pair.first_ns, before.second_ns);
    before = pair;
    ++count;
  }
  EXPECT_GT(count, 20U);
}

TEST(TimingScans, AreNotPairedWithThoseBeforeAClear) {
  TimingScans timing;
  std::vector<Found> found;
  Pose2 pose;
  for (int i = 0; i < 600; ++i) {
    if (i == 310) timing.clear();
    pose = pose * with_a_curve(i);
    timing.add(i * kPeriod_ns, pose, pose, {});
    if (const auto pair = timing.take())
      EXPECT_TRUE(pair->second.stamp_ns < 310 * kPeriod_ns ||
                  pair->first.stamp_ns >= 310 * kPeriod_ns);
  }
}

}  // namespace
}  // namespace slammot::localization
