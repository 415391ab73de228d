#include "common/sensing/odometry_buffer.hpp"

#include <algorithm>
#include <numbers>
#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/matchers.hpp"

namespace slammot::sensing {
namespace {

using geometry::Pose2;
using slammot::testing::PoseNear;

Odometry sample(std::int64_t stamp_ns, double x_m) { return {stamp_ns, {x_m, 0.0, 0.0}}; }

TEST(OdometryBuffer, InterpolatesBetweenTheNeighbours) {
  OdometryBuffer buffer;
  buffer.add({1000, {1.0, 0.0, 3.1}});
  buffer.add({2000, {3.0, 4.0, -3.1}});
  EXPECT_THAT(*buffer.wheel_from_base_at(1250),
              PoseNear(geometry::interpolate({1.0, 0.0, 3.1}, {3.0, 4.0, -3.1}, 0.25), 1e-12));
  EXPECT_THAT(*buffer.wheel_from_base_at(1500), PoseNear(Pose2{2.0, 2.0, std::numbers::pi}, 1e-12));
}

TEST(OdometryBuffer, GivesTheSampleItselfAtItsStamp) {
  OdometryBuffer buffer;
  buffer.add(sample(1000, 1.0));
  buffer.add(sample(2000, 2.0));
  EXPECT_EQ(buffer.wheel_from_base_at(1000)->x_m, 1.0);
  EXPECT_EQ(buffer.wheel_from_base_at(2000)->x_m, 2.0);
}

TEST(OdometryBuffer, SaysNothingOutsideWhatItKnows) {
  OdometryBuffer buffer;
  EXPECT_TRUE(buffer.empty());
  EXPECT_FALSE(buffer.wheel_from_base_at(1000));
  buffer.add(sample(1000, 1.0));
  EXPECT_FALSE(buffer.wheel_from_base_at(999));
  EXPECT_FALSE(buffer.wheel_from_base_at(1001));
  EXPECT_TRUE(buffer.wheel_from_base_at(1000));
}

TEST(OdometryBuffer, GoesOnFromAStampAtTheVelocityOfTheLastMoments) {
  OdometryBuffer buffer;
  for (int i = 0; i <= 20; ++i) buffer.add({i * 10'000'000LL, {0.02 * i, 0.01 * i, 0.0}});
  EXPECT_THAT(*buffer.wheel_from_base_after(200'000'000, 50'000'000),
              PoseNear(Pose2{0.5, 0.25, 0.0}, 1e-12));
  EXPECT_THAT(*buffer.wheel_from_base_after(200'000'000, -50'000'000),
              PoseNear(Pose2{0.3, 0.15, 0.0}, 1e-12));
  EXPECT_FALSE(buffer.wheel_from_base_after(50'000'000, 10'000'000));  // the velocity there is not
                                                                       // known
  EXPECT_FALSE(buffer.wheel_from_base_after(210'000'000, 10'000'000));
}

TEST(OdometryBuffer, GivesWhatItHasSinceAStamp) {
  OdometryBuffer buffer;
  for (int i = 0; i < 5; ++i) buffer.add(sample(i * 100, i));
  const std::vector<Odometry> since = buffer.since(250);
  ASSERT_EQ(since.size(), 2U);
  EXPECT_EQ(since.front().stamp_ns, 300);
  EXPECT_TRUE(buffer.since(500).empty());
}

TEST(OdometryBuffer, IsNotDenseWhereSamplesWereStampedInBursts) {
  OdometryBuffer buffer;
  for (const std::int64_t stamp_ns : {0, 100, 200, 300, 700, 701, 702, 800})
    buffer.add(sample(stamp_ns, 0.0));
  EXPECT_TRUE(buffer.is_dense(0 + 50, 300, 100));
  EXPECT_FALSE(buffer.is_dense(250, 400, 100));  // nothing for four times as long, and then all at
                                                 // once
  EXPECT_TRUE(buffer.is_dense(701, 800, 100));
  EXPECT_FALSE(buffer.is_dense(701, 801, 100));  // what comes then is not known
  EXPECT_FALSE(buffer.is_dense(-10, 300, 100));
}

TEST(OdometryBuffer, SaysTheSameOfWhatFollowedAStampWhenThatIsKnown) {
  OdometryBuffer buffer;
  for (int i = 0; i <= 20; ++i) buffer.add(sample(i * 10'000'000LL, 0.02 * i));
  const auto before = buffer.wheel_from_base_after(200'000'000, 50'000'000);
  buffer.add(sample(300'000'000, 9.0));
  EXPECT_THAT(*buffer.wheel_from_base_after(200'000'000, 50'000'000), PoseNear(*before, 1e-15));
}

TEST(OdometryBuffer, ReachesAStampOnceASampleIsAsNew) {
  OdometryBuffer buffer;
  EXPECT_FALSE(buffer.reaches(0));
  buffer.add(sample(1000, 1.0));
  EXPECT_TRUE(buffer.reaches(1000));
  EXPECT_FALSE(buffer.reaches(1001));
}

TEST(OdometryBuffer, KeepsTheFirstOfTwoSamplesOfOneStamp) {
  OdometryBuffer buffer;
  buffer.add(sample(1000, 1.0));
  buffer.add(sample(1000, 7.0));
  EXPECT_EQ(buffer.wheel_from_base_at(1000)->x_m, 1.0);
}

TEST(OdometryBuffer, DoesNotCareInWhichOrderSamplesCome) {
  std::vector<Odometry> samples;
  for (int i = 0; i < 200; ++i) samples.push_back(sample(1000 * i, 0.01 * i * i));
  OdometryBuffer in_order;
  for (const Odometry& one : samples) in_order.add(one);
  std::mt19937 random(5);
  std::shuffle(samples.begin(), samples.end(), random);
  OdometryBuffer shuffled;
  for (const Odometry& one : samples) shuffled.add(one);
  for (std::int64_t stamp_ns = 0; stamp_ns < 199'000; stamp_ns += 137) {
    EXPECT_EQ(*shuffled.wheel_from_base_at(stamp_ns), *in_order.wheel_from_base_at(stamp_ns));
  }
}

TEST(OdometryBuffer, UsesALateSampleFromThenOn) {
  OdometryBuffer buffer;
  buffer.add(sample(1000, 0.0));
  buffer.add(sample(3000, 2.0));
  EXPECT_DOUBLE_EQ(buffer.wheel_from_base_at(2000)->x_m, 1.0);
  buffer.add(sample(2000, 1.5));
  EXPECT_DOUBLE_EQ(buffer.wheel_from_base_at(2000)->x_m, 1.5);
}

TEST(OdometryBuffer, ForgetsTheOldestWhenFullAndKeepsItsCapacity) {
  OdometryBuffer buffer(10);
  for (int i = 0; i < 1000; ++i) {
    buffer.add(sample(i, i));
    for (int kept = std::max(0, i - 9); kept <= i; ++kept)
      ASSERT_EQ(buffer.wheel_from_base_at(kept)->x_m, kept);
  }
  EXPECT_FALSE(buffer.wheel_from_base_at(900));
}

}  // namespace
}  // namespace slammot::sensing
