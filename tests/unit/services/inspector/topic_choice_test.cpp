#include "services/inspector/topic_choice.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace slammot::inspector {
namespace {

const std::set<std::string> kNames = {"slammot/laser_scan", "rt/odom"};

TEST(TopicMeant, IsTheNameWithOrWithoutItsPrefix) {
  EXPECT_EQ(topic_meant("slammot/laser_scan", kNames), "slammot/laser_scan");
  EXPECT_EQ(topic_meant("laser_scan", kNames), "slammot/laser_scan");
  EXPECT_EQ(topic_meant("rt/odom", kNames), "rt/odom");
  EXPECT_EQ(topic_meant("odom", kNames), std::nullopt);
}

TEST(UnknownTopic, HintsAtTheNearestOne) {
  EXPECT_THAT(unknown_topic("laser_scans", kNames), ::testing::HasSubstr("'laser_scan'"));
  EXPECT_THAT(unknown_topic("x", {}), ::testing::HasSubstr("nobody is on the bus"));
}

}  // namespace
}  // namespace slammot::inspector
