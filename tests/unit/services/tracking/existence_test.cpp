#include "services/tracking/existence.hpp"

#include <cmath>

#include <gtest/gtest.h>

namespace slammot::tracking {
namespace {

constexpr double kPeriodS = 0.027;

TEST(Existence, IsTheProbabilityOfItsLogOdds) {
  EXPECT_DOUBLE_EQ(existence_of(0.0), 0.5);
  EXPECT_NEAR(existence_of(std::log(19.0)), 0.95, 1e-12);
  for (const double score : {-5.0, -0.3, 2.0})
    EXPECT_NEAR(existence_of(score) + existence_of(-score), 1.0, 1e-12);
}

TEST(MotionEvidence, CountsAnUndecidedEchoForHalf) {
  EXPECT_DOUBLE_EQ((MotionEvidence{3.0, 1.0, 4.0}.weight()), 6.0);
}

TEST(Consistency, IsThatOfTheLastMoments) {
  Consistency consistency;
  for (int scan = 0; scan < 200; ++scan) consistency = with_scan(consistency, 0.3, 6.0, kPeriodS);
  EXPECT_NEAR(consistency.off_sides_m, 0.3, 1e-9);
  EXPECT_NEAR(consistency.nis, 6.0, 1e-9);
  for (int scan = 0; scan < 60; ++scan) consistency = with_scan(consistency, 0.02, 1.0, kPeriodS);
  EXPECT_NEAR(consistency.off_sides_m, 0.02, 0.01);
  EXPECT_NEAR(consistency.nis, 1.0, 0.2);
}

TEST(Consistency, IsNotDecidedByASingleOutlier) {
  Consistency consistency;
  for (int scan = 0; scan < 200; ++scan) consistency = with_scan(consistency, 0.02, 2.0, kPeriodS);
  EXPECT_LT(with_scan(consistency, 0.02, 1e6, kPeriodS).nis, 6.0);
}

TEST(Consistency, HasTheWeightOfTheScansWithinItsMemory) {
  Consistency rare;
  Consistency dense;
  for (int scan = 0; scan < 400; ++scan) {
    rare = with_scan(rare, 0.0, 0.0, 0.4);
    dense = with_scan(dense, 0.0, 0.0, 0.04);
  }
  EXPECT_NEAR(rare.weight, 1.0 / (1.0 - std::exp(-1.0)), 1e-6);
  EXPECT_GT(dense.weight, 5.0 * rare.weight);
}

TEST(BeamPassage, IsTheShareOfBeamsThroughTheInterior) {
  BeamPassage passage;
  EXPECT_EQ(passage.share(), 0.0);
  for (int scan = 0; scan < 200; ++scan) passage = with_beams(passage, 5, 15, kPeriodS);
  EXPECT_NEAR(passage.share(), 0.25, 1e-6);
  for (int scan = 0; scan < 200; ++scan) passage = with_beams(passage, 0, 15, kPeriodS);
  EXPECT_NEAR(passage.share(), 0.0, 1e-4);
}

}  // namespace
}  // namespace slammot::tracking
