#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/command_line_call.hpp"
#include "tests/support/temporary_folder.hpp"

namespace slammot {
namespace {

using ::testing::HasSubstr;
using testing::Outcome;
using ::testing::StartsWith;

Outcome config_command(std::vector<std::string> words) {
  words.insert(words.begin(), "config");
  return testing::call(std::move(words));
}

std::string read(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

class ConfigCommand : public ::testing::Test {
 protected:
  ConfigCommand() { ::setenv("SLAMMOT_PROFILES", SLAMMOT_SOURCE_DIR "/deploy/profiles", 1); }

  testing::TemporaryFolder folder_;
};

TEST_F(ConfigCommand, ExplainsASettingByTheEndOfItsName) {
  const Outcome outcome = config_command({"--explain", "side_m"});
  EXPECT_EQ(outcome.exit_code, kExitDone);
  EXPECT_THAT(outcome.standard_output,
              HasSubstr("  localization.map.side_m  (m, 10 to 1000, default "));
}

TEST_F(ConfigCommand, LimitsSettingsWithUnitsToWhatCanBe) {
  for (const char* name : {"localization.match_range_m", "tracking.range_noise_m",
                           "tracking.shape_noise_m", "tracking.fastest_mps"})
    EXPECT_THAT(config_command({"--explain", name}).standard_output,
                HasSubstr(", above 0 up to 1000, default "));
}

TEST_F(ConfigCommand, ExplainsEverySettingWithoutAName) {
  const std::string explained = config_command({"--explain"}).standard_output;
  for (const char* name :
       {"ingest.sweep_s", "localization.map.cell_size_m", "detection.longest_mover_m", "tracking.",
        "loop_closing.sure_within_m", "map_store.max_database_mb"}) {
    EXPECT_THAT(explained, HasSubstr(name));
  }
}

TEST_F(ConfigCommand, NamesTheNearestSettingOfAnUnknownName) {
  const Outcome outcome = config_command({"--explain", "celsize_m"});
  EXPECT_EQ(outcome.exit_code, kExitUsage);
  EXPECT_EQ(outcome.standard_error,
            "slammot: no setting or group is called 'celsize_m'; the nearest one is 'cell_size_m'; "
            "slammot config --explain lists all\n");
}

TEST_F(ConfigCommand, NamesNoSettingWhereNoneIsNear) {
  const Outcome outcome = config_command({"--explain", "NONSENSE"});
  EXPECT_EQ(outcome.exit_code, kExitUsage);
  EXPECT_EQ(outcome.standard_error,
            "slammot: no setting or group is called 'NONSENSE'; "
            "slammot config --explain lists all\n");
}

TEST_F(ConfigCommand, PrintsWhatARunWouldUseAsAFileThatReadsBack) {
  const std::filesystem::path changes = folder_ / "changes";
  std::ofstream(changes) << "localization { map { side_m: 77 } }";
  const std::string effective =
      config_command({"--effective", "--profile", "indoor", "--config", changes.string()})
          .standard_output;
  EXPECT_THAT(effective, HasSubstr("    side_m: 77 "));
  EXPECT_THAT(effective, HasSubstr("    cell_size_m: 0.05 "));
  std::ofstream(folder_ / "effective") << effective;
  EXPECT_EQ(
      config_command({"--effective", "--config", (folder_ / "effective").string()}).standard_output,
      effective);
}

TEST_F(ConfigCommand, RejectsContradictoryOptionsInOneLine) {
  for (const std::vector<std::string>& words :
       std::vector<std::vector<std::string>>{{},
                                             {"--explain", "side_m", "--effective"},
                                             {"--explain", "--profile", "indoor"},
                                             {"--effective", "--profile", "moon"}}) {
    const Outcome outcome = config_command(words);
    EXPECT_EQ(outcome.exit_code, kExitUsage);
    EXPECT_THAT(outcome.standard_error, StartsWith("slammot: "));
    EXPECT_EQ(std::ranges::count(outcome.standard_error, '\n'), 1) << outcome.standard_error;
  }
}

TEST_F(ConfigCommand, FailsWhereAFileOfSettingsIsMissing) {
  const Outcome outcome = config_command({"--effective", "--config", "/nowhere"});
  EXPECT_EQ(outcome.exit_code, kExitFault);
  EXPECT_EQ(std::ranges::count(outcome.standard_error, '\n'), 1) << outcome.standard_error;
}

TEST_F(ConfigCommand, MatchesThePageOfTheDocumentation) {
  EXPECT_EQ(config_command({"--page"}).standard_output,
            read(SLAMMOT_SOURCE_DIR "/docs/settings.md"))
      << "write it again: slammot config --page > docs/settings.md";
}

TEST_F(ConfigCommand, ListsTheSettingsInItsHelp) {
  EXPECT_THAT(config_command({"--help"}).standard_output,
              HasSubstr("  localization.map.side_m = "));
}

}  // namespace
}  // namespace slammot
