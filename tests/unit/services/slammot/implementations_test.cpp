#include "services/slammot/implementations.hpp"

#include <set>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace slammot {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;

template <typename Stage>
void expect_distinct(std::span<const Implementation<Stage>> all) {
  std::set<std::string_view> names, programs;
  for (const Implementation<Stage>& one : all) {
    EXPECT_TRUE(names.insert(one.name).second) << one.name;
    EXPECT_TRUE(programs.insert(one.program).second) << one.program;
  }
}

TEST(Implementations, HaveNamesAndProgramsOfTheirOwn) {
  expect_distinct(localization_implementations());
  expect_distinct(tracking_implementations());
}

TEST(Implementations, BeginWithTheDefault) {
  const ImplementationChoice defaults;
  EXPECT_EQ(localization_implementations().front().name, defaults.localization);
  EXPECT_EQ(tracking_implementations().front().name, defaults.tracking);
  EXPECT_THAT(replaced_stages(defaults), IsEmpty());
}

TEST(Implementations, EachMakesAStageThatHasSeenNothing) {
  for (const LocalizationImplementation& one : localization_implementations()) EXPECT_EQ(one.make({}, nullptr)->named_counters().at("scans"), 0U) << one.name;
  for (const TrackingImplementation& one : tracking_implementations()) EXPECT_EQ(one.make({}, nullptr)->named_counters().at("scans"), 0U) << one.name;
}

TEST(Implementations, NamesTheKnownOnesWhereANameIsUnknown) {
  const auto fault = find_fault({.localization = "standard", .tracking = "gready"});
  ASSERT_TRUE(fault);
  EXPECT_THAT(*fault, HasSubstr("tracking: \"gready\""));
  for (const TrackingImplementation& one : tracking_implementations()) EXPECT_THAT(*fault, HasSubstr(std::string(one.name)));
  EXPECT_TRUE(find_fault({.localization = "", .tracking = "standard"}));
  EXPECT_FALSE(find_fault({.localization = "standard", .tracking = "standard"}));
}

}  // namespace
}  // namespace slammot
