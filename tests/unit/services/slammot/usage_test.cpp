#include "services/slammot/usage.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <CLI/CLI.hpp>

#include "tests/support/command_line_call.hpp"
#include "tests/support/temporary_folder.hpp"

namespace slammot {
namespace {

using testing::call;
using ::testing::HasSubstr;
using testing::Outcome;

void expect_usage_fault(const std::vector<std::string>& words, const std::string& part) {
  const Outcome outcome = call(words);
  EXPECT_EQ(outcome.exit_code, kExitUsage) << part;
  EXPECT_EQ(outcome.standard_output, "") << part;
  EXPECT_THAT(outcome.standard_error, HasSubstr(part));
  EXPECT_EQ(std::ranges::count(outcome.standard_error, '\n'), 1) << outcome.standard_error;
}

TEST(CommandLine, ListsItsCommandsInGroupsWithoutWords) {
  const Outcome outcome = call({});
  EXPECT_EQ(outcome.exit_code, kExitUsage);
  for (const char* const part :
       {"Process a drive:", "Look at a drive or a result:", "Settings, maps and keys:", "\n  run ",
        "\n  report ", "\n  completion "})
    EXPECT_THAT(outcome.standard_output, HasSubstr(part));
}

TEST(ShellWord, IsQuotedUnlessItIsPlain) {
  EXPECT_EQ(shell_word("out/drive_1.log.gz"), "out/drive_1.log.gz");
  EXPECT_EQ(shell_word("my drives/a.log"), "'my drives/a.log'");
  EXPECT_EQ(shell_word("it's $HOME"), "'it'\\''s $HOME'");
  EXPECT_EQ(shell_word(""), "''");
}

TEST(CommandLine, NamesUnknownCommandsWithTheNearestOne) {
  expect_usage_fault({"repotr", "--output", "x"},
                     "unknown command 'repotr'; the nearest one is 'report'");
  expect_usage_fault({"zzz", "--help"}, "unknown command 'zzz'");
  expect_usage_fault({"map", "merg"}, "unknown command 'map merg'; the nearest one is 'merge'");
}

TEST(CommandLine, NamesUnknownOptionsWithTheNearestOne) {
  expect_usage_fault({"run", "--inptu", "x"}, "unknown option '--inptu' of run");
  expect_usage_fault({"run", "--inptu=x"}, "the nearest one is '--input'");
  expect_usage_fault({"run", "-q"}, "unknown option '-q' of run");
  expect_usage_fault({"--verison"}, "unknown option '--verison'; the nearest one is '--version'");
}

TEST(CommandLine, NamesMissingArgumentsWithTheirMeaning) {
  expect_usage_fault({"map", "merge", "--output", "x"}, "slammot map merge: FIRST is missing");
  expect_usage_fault({"map", "merge", "--output", "x"}, "Map that defines the frame");
  expect_usage_fault({"run", "--scenario", "block"}, "--output is missing (DIR: ");
  expect_usage_fault({"map"}, "a command is missing, one of: merge");
}

TEST(CommandLine, RefusesArgumentsThatDoNotFit) {
  expect_usage_fault({"report"}, "a result is required");
  expect_usage_fault({"report", "a", "b", "--truth", "x"}, "--truth belongs to the report of one");
  expect_usage_fault({"plot", "map", "a", "--output", "a.jpg"}, "must end with .png or .svg");
  expect_usage_fault({"bench", "--input", "a.log", "--scenario", "demo", "--output", "x"},
                     "exclude each other");
}

TEST(CommandLine, TakesHelpAndVersionAsCommands) {
  EXPECT_EQ(call({"version"}).standard_output, call({"--version"}).standard_output);
  EXPECT_EQ(call({"help"}).standard_output, call({"--help"}).standard_output);
  const Outcome help_of_run = call({"help", "run"});
  EXPECT_EQ(help_of_run.exit_code, kExitDone);
  EXPECT_THAT(help_of_run.standard_output, HasSubstr("--iterations"));
  expect_usage_fault({"help", "repotr"}, "unknown command 'repotr'");
}

TEST(CommandLine, StatesWhatAnOptionExpects) {
  expect_usage_fault({"run", "--scenario", "block", "--output", "x", "--seed", "zzz"},
                     "--seed does not take 'zzz', but a whole number: Seed");
  expect_usage_fault({"run", "--scenario", "block", "--output"}, "--output lacks its value");
  expect_usage_fault({"run", "--iterations", "99", "--output", "x"}, "not in range");
}

TEST(CommandLine, RefusesNumbersThatMakeNoSense) {
  for (const std::vector<std::string>& words : std::vector<std::vector<std::string>>{
           {"hz", "laser_scan", "--period", "nan"},
           {"hz", "laser_scan", "--count", "-1"},
           {"record", "--duration", "nan"},
           {"play", "a.mcap", "--wait", "inf"},
           {"play", "a.mcap", "--speed", "-1"},
           {"live", "--speed", "-1"},
           {"live", "--speed", "nan"},
           {"run", "--scenario", "block", "--output", "x", "--seed", "-1"},
           {"simulate", "block", "--output", "x", "--seed", "-1"},
           {"eval", "--result", "a", "--truth", "b", "--range", "nan"},
           {"eval", "--result", "a", "--truth", "b", "--bearings", "nan", "1"},
           {"animate", "a", "--from", "nan"}})
    expect_usage_fault(words, "' is not ");
}

TEST(CommandLine, RefusesUnknownScenarios) {
  for (const std::vector<std::string>& words :
       std::vector<std::vector<std::string>>{{"run", "--scenario", "nosuch", "--output", "x"},
                                             {"bench", "--scenario", "nosuch", "--output", "x"},
                                             {"live", "--scenario", "nosuch"},
                                             {"simulate", "nosuch", "--output", "x"}})
    expect_usage_fault(words, "no scenario is named 'nosuch'");
}

TEST(CommandLine, RefusesAStartFarFromAllStreetsAndADirectionInDegrees) {
  const testing::TemporaryFolder folder;
  std::ofstream(folder / "a.geojson")
      << R"({"features": [{"geometry": {"type": "LineString", "coordinates":)"
      << R"( [[-79.99, 40.44], [-79.99, 40.45]]}}]})";
  std::ofstream(folder / "way.tum") << "0 0 0 0 0 0 0 1\n1 200 0 0 0 0 0 1\n";
  const std::vector<std::string> words{"streets", "--trajectory", folder / "way.tum", "--streets",
                                       folder / "a.geojson"};
  std::vector<std::string> swapped = words;
  swapped.insert(swapped.end(), {"--near", "-79.99,40.44"});
  const Outcome outcome = call(swapped);
  EXPECT_EQ(outcome.exit_code, kExitFault);
  EXPECT_THAT(outcome.standard_error, HasSubstr("km from the nearest street"));
  EXPECT_THAT(outcome.standard_error, HasSubstr("LATITUDE,LONGITUDE?"));
  std::vector<std::string> degrees = words;
  degrees.insert(degrees.end(), {"--x-from-east", "90"});
  expect_usage_fault(degrees, "' is not a number from");
}

TEST(CommandLine, RefusesToMergeAMapIntoItself) {
  const testing::TemporaryFolder folder;
  std::filesystem::create_directory(folder / "a");
  std::filesystem::create_directory(folder / "b");
  std::filesystem::create_directory_symlink(folder / "a", folder / "link");
  const std::string a = folder / "a", b = folder / "b", link = folder / "link";
  expect_usage_fault({"map", "merge", a, a, "--output", folder / "c"}, "are one map");
  expect_usage_fault({"map", "merge", a, link + "/", "--output", folder / "c"}, "are one map");
  expect_usage_fault({"map", "merge", a, b, "--output", b + "/../a/"},
                     "holds a map that is merged");
  expect_usage_fault({"map", "merge", b, a + "/map.sqlite", "--output", link},
                     "holds a map that is merged");
}

TEST(CommandLine, TakesNegativeNumbersForValues) {
  EXPECT_EQ(unknown_word(CLI::App{}, {"-", "-1", "-.5"}), std::nullopt);
}

}  // namespace
}  // namespace slammot
