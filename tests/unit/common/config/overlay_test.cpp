#include "common/config/overlay.hpp"

#include <array>
#include <cstdlib>
#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/config/replaced_settings.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/unit/common/config/example_stage.hpp"

namespace slammot::config {
namespace {

/// What overlaying the text says: "" when it is accepted.
std::string fault_of(std::string_view text, ExampleConfig& config) {
  const std::array stages = {bind_example(config)};
  const auto fault = overlay_text(text, "drive.textproto", stages);
  return fault ? fault->text() : "";
}

std::string fault_of(std::string_view text) {
  ExampleConfig config;
  return fault_of(text, config);
}

TEST(Overlay, OfAnEmptyFileLeavesTheDefaults) {
  ExampleConfig config;
  EXPECT_EQ(fault_of("", config), "");
  EXPECT_EQ(config.window_scans, ExampleConfig{}.window_scans);
  EXPECT_EQ(config.resend_after_s, ExampleConfig{}.resend_after_s);
}

TEST(Overlay, ChangesOnlyWhatTheFileSets) {
  ExampleConfig config;
  EXPECT_EQ(fault_of("example { window_scans: 3 offset { x_m: 0 } }  # a comment", config), "");
  EXPECT_EQ(config.window_scans, 3);
  EXPECT_EQ(config.offset.x_m, 0.0);
  EXPECT_EQ(config.resend_after_s, 1.0);
}

TEST(Overlay, LetsTheLaterFileWin) {
  ExampleConfig config;
  EXPECT_EQ(fault_of("example { window_scans: 3 resend_after_s: 2.5 }", config), "");
  EXPECT_EQ(fault_of("example { window_scans: 4 }", config), "");
  EXPECT_EQ(config.window_scans, 4);
  EXPECT_EQ(config.resend_after_s, 2.5);
}

TEST(Overlay, SaysWhereAnUnknownFieldStands) {
  EXPECT_THAT(fault_of("# first line\nexample {\n  windw_scans: 3\n}"),
              ::testing::AllOf(::testing::StartsWith("drive.textproto:3:"),
                               ::testing::HasSubstr("windw_scans")));
}

TEST(Overlay, NamesTheNearestSettingThatThereIs) {
  EXPECT_EQ(fault_of("example {\n  windw_scans: 3\n}"),
            "drive.textproto:2:14: no setting is called 'windw_scans' here; the nearest one is "
            "'window_scans'");
}

TEST(Overlay, NamesWhatReplacedASettingOfEarlierVersions) {
  EXPECT_EQ(fault_of("loop_closing { revisit { max_window_m: 12 } }"),
            "drive.textproto:1:24: no setting is called 'revisit' here; "
            "'loop_closing { surroundings: building }' took its place");
}

TEST(Overlay, HasNoneOfTheReplacedSettingsAndTheWholeOfTheirReplacements) {
  for (const ReplacedSetting& setting : kReplacedSettings) {
    const std::string replacement(setting.replacement);
    if (replacement.find("...") == std::string::npos)
      EXPECT_EQ(fault_of(replacement), "") << setting.name;
  }
}

TEST(Overlay, TakesUpTheBaseThatAFileNamesFirst) {
  testing::TemporaryFolder folder;
  ::setenv("SLAMMOT_PROFILES", folder.path().c_str(), 1);
  std::ofstream(folder / "slow.textproto") << "example { window_scans: 3 resend_after_s: 9 }";
  std::ofstream(folder / "slower.textproto") << "base: \"slow\" example { resend_after_s: 10 }";
  ExampleConfig config;
  EXPECT_EQ(fault_of("example { window_scans: 4 } base: \"slower\"", config), "");
  EXPECT_EQ(config.window_scans, 4);
  EXPECT_EQ(config.resend_after_s, 10.0);
}

TEST(Overlay, SaysWhatIsWrongWithABase) {
  testing::TemporaryFolder folder;
  ::setenv("SLAMMOT_PROFILES", folder.path().c_str(), 1);
  std::ofstream(folder / "faulty.textproto") << "example { window_scans: 0 }";
  std::ofstream(folder / "circle.textproto") << "base: \"circle\"";
  EXPECT_THAT(fault_of("example {}\nbase: \"moon\""),
              ::testing::StartsWith("drive.textproto:2:1: base: unknown profile 'moon'"));
  EXPECT_THAT(fault_of("base: \"faulty\""),
              ::testing::HasSubstr("faulty.textproto:1:11: example.window_scans = 0"));
  EXPECT_THAT(
      fault_of("base: \"circle\""),
      ::testing::HasSubstr("circle.textproto:1:1: base: profiles that are each other's base"));
}

TEST(Overlay, SaysWhereAnUnknownStageStands) {
  EXPECT_THAT(fault_of("ingest {}\nlocalisation {}"),
              ::testing::AllOf(::testing::StartsWith("drive.textproto:2:"),
                               ::testing::HasSubstr("localisation")));
}

TEST(Overlay, SaysWhereTheSyntaxBreaks) {
  EXPECT_THAT(fault_of("example {\n  window_scans 3\n}"),
              ::testing::StartsWith("drive.textproto:2:16: "));
  EXPECT_THAT(fault_of("example {\n  window_scans: three\n}"),
              ::testing::StartsWith("drive.textproto:2:17: "));
  EXPECT_THAT(fault_of("example {"), ::testing::StartsWith("drive.textproto:1:"));
}

TEST(Overlay, SaysWhereAValueOutOfRangeStands) {
  EXPECT_EQ(fault_of("example {\n  resend_after_s: 1\n  window_scans: 0\n}"),
            "drive.textproto:3:3: example.window_scans = 0 is outside [1, 100]: Scans in flight.");
  EXPECT_THAT(fault_of("example { resend_after_s: nan }"),
              ::testing::StartsWith("drive.textproto:1:11: "));
}

TEST(Overlay, SaysWhereAValueOutOfRangeStandsInANestedMessage) {
  EXPECT_EQ(fault_of("example {\n  offset {\n    x_m: -1\n  }\n}"),
            "drive.textproto:3:5: example.offset.x_m = -1 is below 0: Ahead.");
}

TEST(Overlay, RefusesAFieldThatIsSetTwice) {
  EXPECT_THAT(fault_of("example { window_scans: 3\nwindow_scans: 4 }"),
              ::testing::StartsWith("drive.textproto:2:"));
}

TEST(Overlay, ChecksTheNamesInStagesThatAreNotBound) {
  EXPECT_EQ(fault_of("map_store { max_database_mb: 1 }"), "");
  EXPECT_NE(fault_of("map_store { max_database: 1 }"), "");
}

TEST(Overlay, SaysSoWhenTheFileCannotBeRead) {
  EXPECT_EQ(overlay_file("/nowhere/at.textproto", {})->text(),
            "/nowhere/at.textproto: cannot be read");
  EXPECT_EQ(overlay_file("/", {})->text(), "/: cannot be read");
}

TEST(DifferencesFromProto, FindsNoneWhereTheyAgree) {
  ExampleConfig config;
  EXPECT_THAT(differences_from_proto(bind_example(config)), ::testing::IsEmpty());
}

TEST(DifferencesFromProto, FindsWhatIsOnlyInTheTable) {
  double strange = 0.0;
  BoundStage stage{"map_store", {{"no_such_field", &strange, "", {}}}};
  EXPECT_THAT(differences_from_proto(stage),
              ::testing::Contains("map_store.no_such_field: only in the table"));
}

TEST(DifferencesFromProto, FindsWhatIsOnlyInTheProto) {
  EXPECT_THAT(differences_from_proto(BoundStage{"map_store", {}}),
              ::testing::Contains("map_store.max_database_mb: not once in the table"));
}

TEST(DifferencesFromProto, FindsTypesThatDiffer) {
  bool not_a_number = false;
  BoundStage stage{"map_store", {{"max_database_mb", &not_a_number, "", {}}}};
  EXPECT_THAT(differences_from_proto(stage),
              ::testing::Contains("map_store.max_database_mb: types differ, or not optional"));
}

}  // namespace
}  // namespace slammot::config
