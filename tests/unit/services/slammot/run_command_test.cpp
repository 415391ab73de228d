// Tests of the command line on small generated logs.
#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <zlib.h>
#include <nlohmann/json.hpp>

#include "tests/support/command_line_call.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/unit/services/slammot/room_log.hpp"

namespace slammot {
namespace {

using testing::call;
using ::testing::HasSubstr;
using ::testing::Not;
using testing::Outcome;
using testing::room_log;

class RunCommand : public ::testing::Test {
 protected:
  RunCommand() { ::setenv("SLAMMOT_PROFILES", SLAMMOT_SOURCE_DIR "/deploy/profiles", 1); }

  void write(const std::string& content) const { std::ofstream(log_, std::ios::binary) << content; }

  std::string read(const std::filesystem::path& path) const {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
  }

  Outcome run(std::vector<std::string> more = {}) const {
    std::vector<std::string> words{"run", "--input", log_.string(), "--output",
                                   (folder_ / "out").string()};
    words.insert(words.end(), more.begin(), more.end());
    return call(words);
  }

  static void expect_one_line(const std::string& text) {
    EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 1) << text;
  }

  testing::TemporaryFolder folder_;
  std::filesystem::path log_ = folder_ / "drive.log";
};

TEST_F(RunCommand, WritesEveryOutputAndReportsItsChoices) {
  write(room_log(60));
  const Outcome outcome = run();
  EXPECT_EQ(outcome.exit_code, kExitDone);
  EXPECT_THAT(outcome.standard_output, HasSubstr("profile:  indoor ("));
  EXPECT_THAT(outcome.standard_output, HasSubstr("results are in " + (folder_ / "out").string()));
  EXPECT_EQ(outcome.standard_error, "");
  for (const char* file : {"online.tum", "trajectory.tum", "tracks.csv", "map.pgm", "map.png",
                           "map.yaml", "moving.pgm", "moving.png", "moving.yaml", "graph.g2o",
                           "report.json", "report.html", "settings.textproto"}) {
    EXPECT_TRUE(std::filesystem::exists(folder_ / "out" / file)) << file;
  }
  const std::string online = read(folder_ / "out" / "online.tum");
  EXPECT_EQ(std::count(online.begin(), online.end(), '\n'), 60);
  EXPECT_THAT(online, HasSubstr("\n105.900000 "));
  const auto report = nlohmann::json::parse(read(folder_ / "out" / "report.json"));
  EXPECT_EQ(report["counts"]["localized_scans"], 60);
  EXPECT_EQ(report["profile"], "indoor");
  EXPECT_NEAR(report["distance_m"].get<double>(), 2.95, 0.2);
  EXPECT_TRUE(report["measured"]["stage_latency"].contains("tracking"));
}

TEST_F(RunCommand, IsReproducible) {
  write(room_log(60));
  std::vector<std::string> first;
  for (const bool again : {false, true}) {
    ASSERT_EQ(run().exit_code, kExitDone);
    std::size_t i = 0;
    for (const char* file : {"online.tum", "trajectory.tum", "tracks.csv", "map.pgm", "map.png",
                             "moving.png", "graph.g2o"}) {
      const std::string content = read(folder_ / "out" / file);
      if (!again) first.push_back(content);
      EXPECT_EQ(content, first.at(i++)) << file;
    }
  }
}

TEST_F(RunCommand, IsReproducibleFromItsSettingsFile) {
  write(room_log(60));
  ASSERT_EQ(run().exit_code, kExitDone);
  const std::filesystem::path settings = folder_ / "kept.textproto";
  std::filesystem::copy_file(folder_ / "out/settings.textproto", settings);
  std::filesystem::rename(folder_ / "out", folder_ / "first");
  ASSERT_EQ(run({"--profile", "urban", "--config", settings.string()}).exit_code, kExitDone);
  for (const char* file : {"online.tum", "trajectory.tum", "tracks.csv", "labels.csv", "map.pgm",
                           "moving.pgm", "graph.g2o", "settings.textproto"}) {
    EXPECT_EQ(read(folder_ / "out" / file), read(folder_ / "first" / file)) << file;
  }
}

TEST_F(RunCommand, ProcessesTheReadablePartOfATruncatedLog) {
  const gzFile file = gzopen(log_.c_str(), "wb");
  const std::string content = room_log(100);
  gzwrite(file, content.data(), static_cast<unsigned>(content.size()));
  gzclose(file);
  std::filesystem::resize_file(log_, std::filesystem::file_size(log_) / 2);
  const Outcome outcome = run();
  EXPECT_EQ(outcome.exit_code, kExitLogIsCut);
  EXPECT_THAT(outcome.standard_error, HasSubstr("is cut off or damaged"));
  const std::string online = read(folder_ / "out" / "online.tum");
  EXPECT_GT(std::count(online.begin(), online.end(), '\n'), 10);
}

TEST_F(RunCommand, NamesFilesOfAnEarlierRunThatItDoesNotReplace) {
  write(room_log(20));
  EXPECT_THAT(run().standard_output, Not(HasSubstr("of an earlier run")));
  std::ofstream(folder_ / "out" / "map.sqlite") << "another drive";
  std::ofstream(folder_ / "out" / "evaluation.json") << "{}";
  EXPECT_THAT(run().standard_output,
              HasSubstr("of an earlier run, not of this one: map.sqlite, evaluation.json in"));
}

TEST_F(RunCommand, SkipsMalformedLinesAndNamesThem) {
  write("FLASER 181 1 2\n" + room_log(20));
  const Outcome outcome = run();
  EXPECT_EQ(outcome.exit_code, kExitDone);
  EXPECT_THAT(outcome.standard_output,
              HasSubstr("malformed lines of the log, skipped: 1; the first: 1"));
}

TEST_F(RunCommand, CheckDoubtsALogWithMalformedLines) {
  write("FLASER 181 1 2\n" + room_log(20));
  const Outcome outcome = call({"check", log_.string()});
  EXPECT_EQ(outcome.exit_code, kExitDoubtful);
  EXPECT_THAT(outcome.standard_output,
              HasSubstr("doubtful   malformed lines of the log, skipped: 1; the first: 1\n"));
}

TEST_F(RunCommand, SurvivesInvalidScans) {
  std::string content = room_log(5);
  for (int i = 0; i < 20; ++i) {
    const std::string stamp = std::to_string(101 + i);
    content += "FLASER 4 nan -1 inf 1e30 0 0 0 0 0 0 " + stamp + ".25 host 1\n";
    content += "FLASER 4 0.001 0 99999 -0 1e6 1e6 3 -9e6 1e6 3 " + stamp + ".5 host 1\n";
    content += "FLASER 2 1 1 0 0 0 0 0 0 " + stamp + ".5 host 1\n";
  }
  write(content);
  EXPECT_EQ(run().exit_code, kExitDone);
  const std::string online = read(folder_ / "out" / "online.tum");
  EXPECT_EQ(std::count(online.begin(), online.end(), '\n'), 65);
}

TEST_F(RunCommand, RejectsBadInputInOneLine) {
  const auto expect_refused = [&](const std::vector<std::string>& more, const std::string& reason,
                                  int exit_code = kExitFault) {
    const Outcome outcome = run(more);
    EXPECT_EQ(outcome.exit_code, exit_code) << reason;
    EXPECT_THAT(outcome.standard_error, HasSubstr(reason));
    expect_one_line(outcome.standard_error);
  };
  expect_refused({}, "no such file");
  write("");
  expect_refused({}, "the file is empty");
  write(room_log(5));
  expect_refused({"--profile", "moon"}, "unknown profile 'moon'", kExitUsage);
  expect_refused({"--speed", "0"}, "neither a number above 0 nor max", kExitUsage);
  expect_refused({"--config", (folder_ / "missing").string()}, "cannot be read");
  std::ofstream(folder_ / "settings") << "localization { fancy: 3 }";
  expect_refused({"--config", (folder_ / "settings").string()}, "settings:1:");
  std::ofstream(folder_ / "out") << "a file in the way";
  expect_refused({}, "cannot make the folder");
}

class RunScenario : public RunCommand, public ::testing::WithParamInterface<const char*> {};

TEST_P(RunScenario, EqualsTheRunOfTheRecordedDrive) {
  const std::string recorded = folder_ / "recorded";
  ASSERT_EQ(call({"simulate", GetParam(), "--output", recorded}).exit_code, kExitDone);
  const std::string log = recorded + "/" + GetParam() + ".log";
  const Outcome from_log = call({"run", "--input", log, "--output", recorded});
  ASSERT_EQ(from_log.exit_code, kExitDone) << from_log.standard_error;
  const Outcome outcome = call({"run", "--scenario", GetParam(), "--output", folder_ / "live"});
  ASSERT_EQ(outcome.exit_code, kExitDone) << outcome.standard_error;
  for (const char* file :
       {"online.tum", "trajectory.tum", "tracks.csv", "map.pgm", "moving.pgm", "graph.g2o"}) {
    EXPECT_EQ(read(folder_ / "live" / file), read(folder_ / "recorded" / file)) << file;
  }
  for (const char* ending : {".tum", ".objects.csv", ".walls.csv"}) {
    EXPECT_EQ(read(folder_ / "live" / (std::string("truth") + ending)),
              read(folder_ / "recorded" / (GetParam() + std::string(ending))))
        << ending;
  }
  auto live = nlohmann::json::parse(read(folder_ / "live" / "report.json"));
  auto by_log = nlohmann::json::parse(read(folder_ / "recorded" / "report.json"));
  for (auto* report : {&live, &by_log}) {
    report->erase("measured");
    report->erase("profile_reason");
    (*report)["input"].erase("file");
  }
  EXPECT_EQ(live, by_log);
}
INSTANTIATE_TEST_SUITE_P(OutsideAndInside, RunScenario,
                         ::testing::Values("far_crossing", "corridor"),
                         [](const auto& info) { return info.param; });

TEST_F(RunCommand, IsUnchangedByOneIteration) {
  ASSERT_EQ(call({"run", "--scenario", "far_crossing", "--output", folder_ / "without"}).exit_code,
            kExitDone);
  ASSERT_EQ(
      call({"run", "--scenario", "far_crossing", "--iterations", "1", "--output", folder_ / "one"})
          .exit_code,
      kExitDone);
  for (const char* file : {"online.tum", "trajectory.tum", "tracks.csv", "labels.csv", "map.pgm",
                           "moving.pgm", "graph.g2o"}) {
    EXPECT_EQ(read(folder_ / "without" / file), read(folder_ / "one" / file)) << file;
  }
  EXPECT_FALSE(nlohmann::json::parse(read(folder_ / "one" / "report.json"))["counters"].contains(
      "iteration"));
}

TEST_F(RunCommand, IteratesScansWithMovingPointsAndCountsEachOnce) {
  ASSERT_EQ(call({"run", "--scenario", "far_crossing", "--output", folder_ / "one"}).exit_code,
            kExitDone);
  ASSERT_EQ(call({"run", "--scenario", "far_crossing", "--iterations", "3", "--output",
                  folder_ / "three"})
                .exit_code,
            kExitDone);
  const auto one = nlohmann::json::parse(read(folder_ / "one" / "report.json"));
  const auto three = nlohmann::json::parse(read(folder_ / "three" / "report.json"));
  EXPECT_EQ(three["counts"]["localized_scans"], one["counts"]["localized_scans"]);
  EXPECT_EQ(three["counters"]["localization"]["scans"], one["counters"]["localization"]["scans"]);
  EXPECT_EQ(three["counters"]["localization"]["fallback_integrations"], 0);
  const auto& iteration = three["counters"]["iteration"];
  EXPECT_GT(iteration["scans_iterated"].get<int>(), 0);
  EXPECT_LE(iteration["scans_iterated"].get<int>(), three["counts"]["localized_scans"].get<int>());
  EXPECT_GE(iteration["matches_again"].get<int>(), iteration["scans_iterated"].get<int>());
  EXPECT_LE(iteration["matches_again"].get<int>(), 2 * iteration["scans_iterated"].get<int>());
  EXPECT_NE(read(folder_ / "three" / "online.tum"), read(folder_ / "one" / "online.tum"));
}

TEST_F(RunCommand, TakesTheLogWithoutAnOption) {
  write(room_log(60));
  ASSERT_EQ(run({"--no-report"}).exit_code, kExitDone);
  const Outcome outcome =
      call({"run", log_.string(), "--output", (folder_ / "second").string(), "--no-report"});
  ASSERT_EQ(outcome.exit_code, kExitDone) << outcome.standard_error;
  EXPECT_EQ(read(folder_ / "second" / "online.tum"), read(folder_ / "out" / "online.tum"));
}

TEST_F(RunCommand, RejectsZeroIterationsAndBenchHasNone) {
  write(room_log(5));
  EXPECT_EQ(run({"--iterations", "0"}).exit_code, kExitUsage);
  EXPECT_EQ(run({"--iterations", "11"}).exit_code, kExitUsage);
  const Outcome bench = call({"bench", "--input", log_.string(), "--output",
                              (folder_ / "out").string(), "--iterations", "2"});
  EXPECT_EQ(bench.exit_code, kExitUsage);
  EXPECT_THAT(bench.standard_error, HasSubstr("--iterations"));
}

TEST_F(RunCommand, RunsAndReportsTheImplementationsInTheSettings) {
  write(room_log(60));
  const std::string settings = folder_ / "settings.textproto";
  std::ofstream(settings) << "implementations { localization: \"icp\" tracking: \"greedy\" }";
  const Outcome outcome = run({"--config", settings});
  ASSERT_EQ(outcome.exit_code, kExitDone) << outcome.standard_error;
  EXPECT_THAT(outcome.standard_output,
              HasSubstr("replaced: localization: icp\nreplaced: tracking: greedy\n"));
  const auto report = nlohmann::json::parse(read(folder_ / "out" / "report.json"));
  EXPECT_EQ(report["replaced_stages"], nlohmann::json({"localization: icp", "tracking: greedy"}));
  EXPECT_EQ(report["counters"]["tracking"]["scans"], 60);
  const std::string online = read(folder_ / "out" / "online.tum");
  EXPECT_EQ(std::count(online.begin(), online.end(), '\n'), 60);
  ASSERT_EQ(run().exit_code, kExitDone);
  EXPECT_FALSE(
      nlohmann::json::parse(read(folder_ / "out" / "report.json")).contains("replaced_stages"));
}

TEST_F(RunCommand, RejectsUnknownAndUnsuitableImplementations) {
  write(room_log(20));
  const std::string settings = folder_ / "settings.textproto";
  std::ofstream(settings) << "implementations { tracking: \"gready\" }";
  const Outcome unknown = run({"--config", settings});
  EXPECT_EQ(unknown.exit_code, kExitFault);
  EXPECT_THAT(unknown.standard_error,
              HasSubstr("no such implementation; there are: standard, greedy"));
  std::ofstream(settings) << "implementations { localization: \"icp\" }";
  const Outcome without_map = run({"--config", settings, "--map", folder_ / "map"});
  EXPECT_EQ(without_map.exit_code, kExitFault);
  EXPECT_THAT(without_map.standard_error,
              HasSubstr("the localization 'icp' cannot continue a stored map"));
}

TEST_F(RunCommand, RequiresEitherALogOrAScenario) {
  const auto expect_refused = [&](std::vector<std::string> words, const std::string& reason) {
    words.insert(words.begin(), {"run", "--output", (folder_ / "out").string()});
    const Outcome outcome = call(words);
    EXPECT_EQ(outcome.exit_code, kExitUsage) << reason;
    EXPECT_THAT(outcome.standard_error, HasSubstr(reason));
    expect_one_line(outcome.standard_error);
  };
  expect_refused({}, "a drive is required");
  expect_refused({"--input", "a.log", "--scenario", "demo"}, "exclude each other");
  expect_refused({"--input", "a.log", "--seed", "3"}, "--seed belongs to --scenario");
  expect_refused({"--scenario", "atlantis"}, "no scenario is named 'atlantis'");
}

struct Refusal {
  int exit_code = 0;
  std::string standard_output;
  std::string standard_error;
};

Refusal call_with(std::vector<std::string> words) {
  words.insert(words.begin(), "slammot");
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  ::testing::internal::CaptureStdout();
  ::testing::internal::CaptureStderr();
  const int exit_code = run_command_line(static_cast<int>(argv.size()), argv.data());
  std::fflush(stdout);
  return {exit_code, ::testing::internal::GetCapturedStdout(),
          ::testing::internal::GetCapturedStderr()};
}

TEST(CommandLine, ListsItsCommandsWithoutArguments) {
  const Refusal refusal = call_with({});
  EXPECT_EQ(refusal.exit_code, kExitUsage);
  EXPECT_THAT(refusal.standard_output, HasSubstr("check"));
  EXPECT_THAT(refusal.standard_output, HasSubstr("simulate"));
}

TEST(CommandLine, NamesAnUnknownCommandAndTheNearestOne) {
  for (const std::vector<std::string>& words :
       {std::vector<std::string>{"chek", "--help"}, {"chek", "a.log"}}) {
    const Refusal refusal = call_with(words);
    EXPECT_EQ(refusal.exit_code, kExitUsage);
    EXPECT_THAT(refusal.standard_error, HasSubstr("'chek'"));
    EXPECT_THAT(refusal.standard_error, HasSubstr("'check'"));
  }
}

TEST(CommandLine, NamesAnUnknownOptionAndTheNearestOne) {
  const Refusal refusal = call_with({"run", "--inptu=a.log"});
  EXPECT_EQ(refusal.exit_code, kExitUsage);
  EXPECT_THAT(refusal.standard_error, HasSubstr("'--inptu'"));
  EXPECT_THAT(refusal.standard_error, HasSubstr("'--input'"));
}

TEST_F(RunCommand, IsPrecededByCheck) {
  write(room_log(60));
  const Outcome sound = call({"check", log_.string()});
  EXPECT_THAT(sound.standard_output, HasSubstr("scans      60 of"));
  EXPECT_THAT(sound.standard_output, HasSubstr("slammot run --input " + log_.string()));
  std::filesystem::copy_file(log_, folder_ / "my drive.log");
  EXPECT_THAT(
      call({"check", folder_ / "my drive.log"}).standard_output,
      HasSubstr("--input '" + (folder_ / "my drive.log").string() + "' --output 'out/my drive'"));
  const std::string log = room_log(60);
  write(log.substr(0, log.size() - 100));
  const Outcome cut = call({"check", log_.string()});
  EXPECT_THAT(cut.standard_output, HasSubstr("doubtful   the file is cut off"));
  EXPECT_EQ(cut.exit_code, kExitDoubtful);
  write("nothing\n");
  EXPECT_EQ(call({"check", log_.string()}).exit_code, kExitFault);
}

TEST_F(RunCommand, AnimateRefusesABeginBeyondTheEndOfTheDrive) {
  write(room_log(20));
  ASSERT_EQ(run({"--no-report"}).exit_code, kExitDone);
  const Outcome outcome = call({"animate", (folder_ / "out").string(), "--from", "5000"});
  EXPECT_EQ(outcome.exit_code, kExitUsage);
  EXPECT_THAT(outcome.standard_error, HasSubstr("--from 5000: the drive ends at 1.9 s"));
  expect_one_line(outcome.standard_error);
}

TEST_F(RunCommand, ReportsWhyScansWereNotLocalized) {
  const std::string log = room_log(60);
  std::string other_scan = log.substr(log.rfind('\n', log.size() - 2) + 1);
  other_scan.replace(other_scan.find('.'), 2, ".01");  // else it would be a scan recorded again
  write(log + other_scan + other_scan);
  EXPECT_THAT(run().standard_output, HasSubstr("not localized: 2 repeat an earlier stamp"));
}

}  // namespace
}  // namespace slammot
