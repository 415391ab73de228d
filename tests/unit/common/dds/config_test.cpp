#include "common/dds/config.hpp"

#include <cstdlib>
#include <stdexcept>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace slammot::dds {
namespace {

using ::testing::HasSubstr;

TEST(LoopbackConfig, StaysOnTheLoopbackInterface) {
  EXPECT_THAT(loopback_config("a"), HasSubstr("<NetworkInterface name=\"lo\"/>"));
  EXPECT_THAT(loopback_config("a"), HasSubstr("<AllowMulticast>false</AllowMulticast>"));
}

TEST(LoopbackConfig, RefusesATagThatWouldBreakTheXml) {
  EXPECT_THROW(loopback_config("a</Tag>"), std::invalid_argument);
  EXPECT_THROW(loopback_config(std::string(201, 'a')), std::invalid_argument);
}

TEST(Config, HasRoomForMoreProcessesThanTheLibrarysTen) {
  for (const std::string& config : {default_config(), loopback_config("a")}) {
    EXPECT_THAT(config, HasSubstr("<MaxAutoParticipantIndex>119</MaxAutoParticipantIndex>"));
  }
}

TEST(Config, OfTheEnvironmentOverlaysTheDefault) {
  ASSERT_EQ(setenv("CYCLONEDDS_URI", "file:///etc/slammot/dds.xml", 1), 0);
  EXPECT_EQ(config_from_environment(), default_config() + ",file:///etc/slammot/dds.xml");
  ASSERT_EQ(unsetenv("CYCLONEDDS_URI"), 0);
  EXPECT_EQ(config_from_environment(), default_config());
}

}  // namespace
}  // namespace slammot::dds
