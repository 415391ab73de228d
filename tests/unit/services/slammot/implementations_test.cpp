#include "services/slammot/implementations.hpp"

#include <set>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "services/slammot/pipeline.hpp"

namespace slammot {
namespace {

using ::testing::ElementsAre;
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

TEST(Implementations, MakeStagesInTheirInitialState) {
  for (const LocalizationImplementation& one : localization_implementations())
    EXPECT_EQ(one.make({}, nullptr)->named_counters().at("scans"), 0U) << one.name;
  for (const TrackingImplementation& one : tracking_implementations())
    EXPECT_EQ(one.make({}, nullptr)->named_counters().at("scans"), 0U) << one.name;
}

TEST(Implementations, AreListedWhereANameIsUnknown) {
  const auto fault = find_fault({.localization = "standard", .tracking = "gready"});
  ASSERT_TRUE(fault);
  EXPECT_THAT(*fault, HasSubstr("tracking: \"gready\""));
  for (const TrackingImplementation& one : tracking_implementations())
    EXPECT_THAT(*fault, HasSubstr(std::string(one.name)));
  EXPECT_TRUE(find_fault({.localization = "", .tracking = "standard"}));
  EXPECT_FALSE(find_fault({.localization = "icp", .tracking = "greedy"}));
}

TEST(Implementations, ReplaceTheStageOfThePipeline) {
  Profile profile;
  profile.implementations = {.localization = "icp", .tracking = "greedy"};
  EXPECT_THAT(replaced_stages(profile.implementations),
              ElementsAre("localization: icp", "tracking: greedy"));
  const auto counters = Pipeline(profile).counters();
  EXPECT_TRUE(counters.at("localization").contains("unmatched_scans"));
  EXPECT_FALSE(counters.at("localization").contains("odometry_jumps"));
  EXPECT_FALSE(counters.at("tracking").contains("points_restored"));
}

/// The cell size of the local map is the profile's.
TEST(Implementations, GetTheSettingsOfTheStageThatTheyReplace) {
  Profile profile;
  profile.implementations.localization = "icp";
  profile.localization.map.cell_size_m = 0.1;
  profile.localization.map.side_m = 50.0;
  Pipeline pipeline(profile);
  sensing::LaserScan scan;
  scan.stamp_ns = 1;
  scan.scanner.max_range_m = 30.0;
  scan.scanner.beam_step_rad = 0.01;
  scan.range_m.assign(100, 5.0F);
  pipeline.take(scan);
  pipeline.finish();
  ASSERT_EQ(pipeline.record().submaps().size(), 1U);
  EXPECT_EQ(pipeline.record().submaps().begin()->second.cell_size_m, 0.1);
}

}  // namespace
}  // namespace slammot
