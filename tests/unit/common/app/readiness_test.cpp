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

}  // namespace
}  // namespace slammot::app
