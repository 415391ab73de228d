#include "services/keys/permissions.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace slammot::keys {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::UnorderedElementsAre;

TEST(Permissions, LetAServicePublishItsOwnTopicsAndWhatEveryServicePublishes) {
  EXPECT_THAT(grant_of("tracking").publishes,
              UnorderedElementsAre("slammot/tracked_objects", "slammot/scan_labels",
                                   "slammot/heartbeat", "slammot/status", "slammot/reply"));
  EXPECT_THAT(grant_of("map-store").publishes, Contains("slammot/stored_submap_tile"));
}

TEST(Permissions, LetTheCommandLineSendCommandsButNoHeartbeats) {
  EXPECT_THAT(grant_of("tools").publishes, ElementsAre("slammot/command"));
}

TEST(Permissions, AreKnownForEveryServiceThatPublishes) {
  EXPECT_THAT(
      project_identities(),
      ElementsAre("collision-warning", "detection", "gateway", "ingest", "localization",
                  "loop-closing", "map-store", "recorder", "simulator", "tools", "tracking"));
}

TEST(Permissions, DenyWhatTheyDoNotGrant) {
  const std::string xml = permissions_xml({"slammot-planner", {}, {"slammot/tracked_objects"}},
                                          {"2026-01-01T00:00:00", "2027-01-01T00:00:00"});
  EXPECT_THAT(xml, HasSubstr("<subject_name>CN=slammot-planner</subject_name>"));
  EXPECT_THAT(xml, HasSubstr("<not_after>2027-01-01T00:00:00</not_after>"));
  EXPECT_THAT(xml, HasSubstr("<subscribe><topics><topic>slammot/tracked_objects</topic>"));
  EXPECT_THAT(xml, HasSubstr("<default>DENY</default>"));
  EXPECT_THAT(xml, Not(HasSubstr("<publish>")));
}

TEST(Permissions, KeepANameOfATopicFromBecomingARule) {
  const std::string xml = permissions_xml({"x", {"a</topic><topic>*"}, {}}, {});
  EXPECT_THAT(xml, Not(HasSubstr("<topic>*</topic>")));
}

}  // namespace
}  // namespace slammot::keys
