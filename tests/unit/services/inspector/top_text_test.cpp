#include "services/inspector/top_text.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace slammot::inspector {
namespace {

using ::testing::HasSubstr;

TEST(ServicesText, ShowsStateStagesReasonAndWhatWasDropped) {
  wire::ServiceStatus service;
  service.name = {"car", "localization", "main"};
  service.process_number = 42;
  service.state = wire::ServiceState::kDegraded;
  service.explanation = "no slammot/laser_scan for 2.1 s";
  service.latencies = {{"localize", 10, 0.5, 1.25, 24.0}, {"integrate", 10, 0.1, 0.2, 0.3}};
  service.counters = {{"stray_scans", 3}, {"scans", 1000}, {"faulty_laser_scan", 0}};
  const std::string text = services_text({service}, 5'000'000'000);
  EXPECT_THAT(text, HasSubstr("car localization  degraded  42       5 s  localize "));
  EXPECT_THAT(text, HasSubstr("0.50    1.25     24.00\n"));
  EXPECT_THAT(text, HasSubstr("car localization: no slammot/laser_scan for 2.1 s\n"));
  EXPECT_THAT(text, HasSubstr("car localization counts stray_scans 3\n"));
}

TEST(ServicesText, NamesAStandby) {
  wire::ServiceStatus service;
  service.name = {"car", "tracking", "second"};
  service.stands_by = true;
  EXPECT_THAT(services_text({service}, 0), HasSubstr("car tracking second  standby"));
}

TEST(TopicsText, ShowsDashesForASilentTopic) {
  TopicLine line;
  line.topic = "slammot/laser_scan";
  line.readers = 2;
  EXPECT_THAT(topics_text({line}), HasSubstr("slammot/laser_scan  0.0   -      -     0       -"));
}

}  // namespace
}  // namespace slammot::inspector
