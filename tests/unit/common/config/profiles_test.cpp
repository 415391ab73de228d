#include "common/config/profiles.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace slammot::config {
namespace {

TEST(FindProfile, FindsTheShippedOnesByName) {
  for (const char* name : {"urban", "indoor"}) EXPECT_TRUE(find_profile(name)) << name;
}

TEST(FindProfile, TakesAPathAsItIs) {
  const auto urban = find_profile("urban");
  ASSERT_TRUE(urban);
  EXPECT_EQ(find_profile(urban->string()), urban);
  EXPECT_EQ(find_profile("./urban.textproto"), std::nullopt);
}

TEST(UnknownProfile, SaysWhichThereAre) {
  EXPECT_EQ(find_profile("moon"), std::nullopt);
  EXPECT_THAT(unknown_profile("moon"),
              ::testing::AllOf(::testing::HasSubstr("'moon'"),
                               ::testing::HasSubstr("indoor, model_cars, outdoor_robot, urban")));
}

}  // namespace
}  // namespace slammot::config
