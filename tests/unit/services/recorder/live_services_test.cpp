#include "services/recorder/live_services.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace slammot::recorder {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

const std::set<std::string> kDrive = {
    "slammot/laser_scan", "slammot/localized_scan", "slammot/tracked_objects", "slammot/heartbeat",
    "slammot/status",     "slammot/command",        "points/of_somebody"};

TEST(LiveServices, ContestWhatTheyPublishAndTheHeartbeat) {
  EXPECT_THAT(contested_topics("tracking", kDrive),
              ElementsAre("slammot/heartbeat", "slammot/tracked_objects"));
  EXPECT_THAT(contested_topics("ingest", kDrive),
              ElementsAre("slammot/heartbeat", "slammot/laser_scan"));
}

TEST(LiveServices, LetTheRestOfADriveBePlayedToThem) {
  EXPECT_THAT(contested_topics("tracking", {"slammot/laser_scan", "slammot/localized_scan"}),
              IsEmpty());
}

TEST(LiveServices, MayLookAtWhatIsPlayed) {
  EXPECT_THAT(contested_topics("gateway", kDrive), IsEmpty());
  EXPECT_THAT(contested_topics("recorder", kDrive), IsEmpty());
  EXPECT_THAT(contested_topics("player", kDrive), IsEmpty());
}

TEST(LiveServices, AreNamedWithWhatToDo) {
  EXPECT_EQ(contest("tracking", "bench", {"slammot/heartbeat", "slammot/tracked_objects"}),
            "tracking of vehicle bench runs on this bus and publishes slammot/heartbeat, "
            "slammot/tracked_objects, too: stop it, leave them out by --topics, or play on another "
            "--domain or --bus");
}

}  // namespace
}  // namespace slammot::recorder
