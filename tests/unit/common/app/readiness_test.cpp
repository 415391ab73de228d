#include "common/app/readiness.hpp"

#include <gtest/gtest.h>

namespace slammot::app {
namespace {

TEST(Readiness, NamesWhatIsNotAtWork) {
  Readiness readiness({"localization", "detection"});
  EXPECT_EQ(readiness.missing(), "detection, localization");
  readiness.heard("localization", true);
  readiness.heard("map_store", true);
  EXPECT_EQ(readiness.missing(), "detection");
  readiness.heard("detection", true);
  EXPECT_EQ(readiness.missing(), "");
  readiness.heard("localization", false);
  EXPECT_EQ(readiness.missing(), "localization");
}

TEST(Readiness, GivesServicesThatRunAMomentToMeet) {
  using namespace std::chrono_literals;
  const std::chrono::steady_clock::time_point now{100s};
  Readiness readiness({"localization"});
  EXPECT_FALSE(readiness.have_met(now));
  EXPECT_FALSE(readiness.have_met(now + 100ms));
  EXPECT_TRUE(readiness.have_met(now + 1s));
}

}  // namespace
}  // namespace slammot::app
