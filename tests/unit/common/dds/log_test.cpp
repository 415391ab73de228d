#include "common/dds/log.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/dds/participant.hpp"

namespace slammot::dds {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

TEST(LogHandler, GetsTheLibrarysWarnings) {
  std::vector<std::string> warnings;
  set_log_handler([&](LogLevel level, std::string_view line) {
    if (level == LogLevel::kWarning) warnings.emplace_back(line);
  });
  // Loopback, and multicast not switched off: worth a warning to the library, not a failure.
  const std::string config =
      "<CycloneDDS><Domain><General><Interfaces><NetworkInterface "
      "name=\"lo\"/></Interfaces></General></Domain></CycloneDDS>";
  { const Participant participant({.domain_id = 217, .name = "log", .config = config}); }
  set_log_handler([](LogLevel, std::string_view) {});
  EXPECT_THAT(warnings, ElementsAre(HasSubstr("multicast")));
}

TEST(LogCapture, IsEmptyWhereNothingWentWrong) { EXPECT_EQ(LogCapture().errors(), ""); }

}  // namespace
}  // namespace slammot::dds
