#include "services/localization/byte_stream.hpp"

#include <limits>

#include <gtest/gtest.h>

namespace slammot::localization {
namespace {

TEST(IsBelievable, RefusesWhatNoEstimateIs) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(is_believable(geometry::Vector2(-1e5, 3.0)));
  EXPECT_FALSE(is_believable(geometry::Vector2(2e300, 0.0)));
  EXPECT_FALSE(is_believable(geometry::Vector2(0.0, nan)));
  EXPECT_TRUE(is_believable(geometry::Pose2{-1e5, 3.0, 40.0}));
  EXPECT_FALSE(is_believable(geometry::Pose2{nan, 0.0, 0.0}));
  EXPECT_FALSE(is_believable(geometry::Pose2{0.0, 1e9, 0.0}));
  EXPECT_FALSE(is_believable(geometry::Pose2{0.0, 0.0, nan}));
  EXPECT_TRUE(is_believable(geometry::Matrix3(geometry::Matrix3::Zero())));
  EXPECT_TRUE(is_believable(geometry::Matrix3{{4.0, 1.0, 0.0}, {1.0, 2.0, 0.5}, {0.0, 0.5, 1.0}}));
  EXPECT_FALSE(is_believable(geometry::Matrix3{{1.0, 2.0, 0.0}, {2.0, 1.0, 0.0}, {0.0, 0.0, 1.0}}));
  EXPECT_FALSE(is_believable(geometry::Matrix3(-geometry::Matrix3::Identity())));
  EXPECT_FALSE(is_believable(geometry::Matrix3(geometry::Matrix3::Constant(nan))));
}

}  // namespace
}  // namespace slammot::localization
