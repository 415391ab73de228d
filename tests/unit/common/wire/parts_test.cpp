#include "common/wire/parts.hpp"

#include <gtest/gtest.h>

#include "tests/support/matchers.hpp"
#include "tests/support/values.hpp"

namespace slammot::wire {
namespace {

using slammot::testing::kNan;

TEST(Parts, CarryAMatrixRowByRow) {
  const Eigen::Matrix2d matrix{{1.0, 2.0}, {3.0, 4.0}};
  double field[4];
  encode_matrix<2>(matrix, field);
  EXPECT_EQ(field[1], 2.0);
  EXPECT_EQ(decode_matrix<2>(field), matrix);
}

TEST(Parts, CarryAnUncertainPoseBitByBit) {
  testing::Random random(1);
  const geometry::UncertainPose2 pose = testing::uncertain_pose(random);
  EXPECT_EQ(decode(encode(pose)).pose, pose.pose);
  EXPECT_EQ(decode(encode(pose)).covariance, pose.covariance);
}

TEST(Parts, RefuseANegativeVarianceButNotARoundingError) {
  const double negative[4] = {1.0, 0.0, 0.0, -1e-3};
  const double rounded[4] = {1.0, 0.0, 0.0, -1e-12};
  const double correlated[4] = {1.0, -0.5, -0.5, 1.0};
  const double unknown[4] = {1.0, kNan, 0.0, 1.0};
  EXPECT_FALSE(is_covariance<2>(negative));
  EXPECT_TRUE(is_covariance<2>(rounded));
  EXPECT_TRUE(is_covariance<2>(correlated));
  EXPECT_FALSE(is_covariance<2>(unknown));
}

TEST(Parts, TakeNanForNeitherAmountNorProbability) {
  EXPECT_FALSE(is_amount(kNan));
  EXPECT_FALSE(is_probability(kNan));
  EXPECT_TRUE(is_probability(1.0 + 1e-9));
  EXPECT_FALSE(is_probability(1.1));
}

}  // namespace
}  // namespace slammot::wire
