#include "common/simulation/random.hpp"

#include <cmath>

#include <gtest/gtest.h>

namespace slammot::simulation {
namespace {

TEST(Random, RepeatsItselfForTheSameSeedAndPurpose) {
  Random a(7, Purpose::scanner);
  Random b(7, Purpose::scanner);
  for (int i = 0; i < 100; ++i) EXPECT_EQ(a.normal(), b.normal());
}

TEST(Random, DiffersBetweenSeedsAndBetweenPurposes) {
  EXPECT_NE(Random(7, Purpose::scanner).uniform(), Random(8, Purpose::scanner).uniform());
  EXPECT_NE(Random(7, Purpose::scanner).uniform(), Random(7, Purpose::traffic).uniform());
}

TEST(Random, DrawsTheNumbersThatAreWrittenHereOnEveryPlatform) {
  Random random(1, Purpose::world);
  EXPECT_EQ(random.uniform(), 0x1.b3370781c5d3ep-1);
  EXPECT_EQ(random.uniform(), 0x1.44d62a86078d4p-2);
}

TEST(Random, StaysInsideTheHalfOpenInterval) {
  Random random(3, Purpose::world);
  for (int i = 0; i < 10000; ++i) {
    const double value = random.uniform(-2.0, 5.0);
    EXPECT_GE(value, -2.0);
    EXPECT_LT(value, 5.0);
    EXPECT_LT(random.index(3), 3U);
  }
}

TEST(Random, HasNormalNumbersOfMeanZeroAndVarianceOne) {
  Random random(5, Purpose::world);
  constexpr int kCount = 200000;
  double sum = 0.0;
  double squares = 0.0;
  int beyond_two_sigma = 0;
  for (int i = 0; i < kCount; ++i) {
    const double value = random.normal();
    sum += value;
    squares += value * value;
    beyond_two_sigma += std::abs(value) > 2.0 ? 1 : 0;
  }
  // Four standard errors of each estimate.
  EXPECT_NEAR(sum / kCount, 0.0, 4.0 / std::sqrt(kCount));
  EXPECT_NEAR(squares / kCount, 1.0, 4.0 * std::sqrt(2.0 / kCount));
  EXPECT_NEAR(static_cast<double>(beyond_two_sigma) / kCount, 0.0455,
              4.0 * std::sqrt(0.0455 / kCount));
}

}  // namespace
}  // namespace slammot::simulation
