#include "services/slammot/lost_watch.hpp"

#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace slammot {
namespace {

using ::testing::HasSubstr;

/// Lines for scans 0.1 s apart: 'L' lost, '.' matched.
std::vector<std::string> lines_for(const std::string& scans) {
  LostWatch watch("wheels that slip");
  std::vector<std::string> lines;
  for (std::size_t i = 0; i < scans.size(); ++i) {
    if (auto line = watch.update(0.1 * static_cast<double>(i), static_cast<std::uint32_t>(i),
                                 scans[i] == 'L'))
      lines.push_back(*line);
  }
  return lines;
}

TEST(LostWatch, ReportsLossAndRecovery) {
  const auto lines = lines_for("....LLLLLLLL........");
  ASSERT_EQ(lines.size(), 2u);
  EXPECT_THAT(lines[0], HasSubstr("lost at 0.4 s (scan 4)"));
  EXPECT_THAT(lines[0], HasSubstr("wheels that slip"));
  EXPECT_THAT(lines[1], HasSubstr("found again at 1.2 s (scan 12)"));
}

TEST(LostWatch, IsSilentAboutShortLosses) { EXPECT_TRUE(lines_for("..LLLL..LL....").empty()); }

TEST(LostWatch, ReportsANewPartOfTheMapAtOnce) {
  LostWatch watch("wheels that slip");
  EXPECT_FALSE(watch.update(0.0, 0, false, 0));
  const auto line = watch.update(0.1, 1, false, 1);
  ASSERT_TRUE(line);
  EXPECT_THAT(*line, HasSubstr("new part of the map"));
  EXPECT_FALSE(watch.update(0.2, 2, false, 1));
}

TEST(LostWatch, LimitsTheNumberOfReports) {
  std::string scans;
  for (int i = 0; i < 50; ++i) scans += "LLLLLL......";
  const auto lines = lines_for(scans);
  EXPECT_LE(lines.size(), 21u);
  EXPECT_THAT(lines.back(), HasSubstr("counted only"));
}

}  // namespace
}  // namespace slammot
