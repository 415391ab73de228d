#include "common/app/run_service.hpp"

#include <cstdlib>
#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <CLI/CLI.hpp>

#include "common/app/service_options.hpp"
#include "common/files/number_option.hpp"
#include "tests/support/dds.hpp"
#include "tests/support/temporary_folder.hpp"

namespace slammot::app {
namespace {

using ::testing::HasSubstr;

struct ExampleService {
  struct Settings {
    int max_database_mb = 1;
    std::string speed = "1";
    double patience_s = 1.0;
  };
  static constexpr const char* kName = "map_store";
  static constexpr const char* kPurpose = "Stands for a service.";
  static std::vector<config::BoundStage> stages(Settings& settings) {
    static const config::FieldTable<Settings> table = {
        {"max_database_mb", &Settings::max_database_mb, "Space.", config::kPositive}};
    return {config::bind_stage("map_store", table, settings)};
  }
  static void add_options(CLI::App& command_line, Settings& settings) {
    add_speed_option(command_line, settings.speed, "Multiple.");
    command_line.add_option("--patience", settings.patience_s)
        ->check(files::number_between(0.1, 3600.0));
  }
  ExampleService(ServiceContext&, const Settings&) { throw StartupFailure("the disk is on fire"); }
};

struct Ran {
  int exit_code;
  std::string out;
  std::string err;
};

Ran run(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), "slammot-map-store");
  std::vector<char*> argv;
  for (std::string& argument : arguments) argv.push_back(argument.data());
  argv.push_back(nullptr);
  ::testing::internal::CaptureStdout();
  ::testing::internal::CaptureStderr();
  const int exit_code =
      run_service<ExampleService>(static_cast<int>(arguments.size()), argv.data());
  return {exit_code, ::testing::internal::GetCapturedStdout(),
          ::testing::internal::GetCapturedStderr()};
}

class RunService : public ::testing::Test {
 protected:
  std::string file(const std::string& text) {
    const auto path = folder_ / "settings.textproto";
    std::ofstream(path) << text;
    return path.string();
  }
  slammot::testing::TemporaryFolder folder_;
};

TEST_F(RunService, ShowsHelpAndVersion) {
  EXPECT_EQ(run({"--help"}).exit_code, 0);
  EXPECT_THAT(run({"--help"}).out,
              ::testing::AllOf(HasSubstr("Stands for a service."), HasSubstr("--print-config")));
  EXPECT_THAT(run({"--version"}).out, ::testing::StartsWith("slammot-map-store "));
}

TEST_F(RunService, IsCalledAsItsProgramAlsoInThePlaceOfAnother) {
  std::string program = "/opt/bin/slammot-other-store", option = "--version";
  std::vector<char*> argv = {program.data(), option.data(), nullptr};
  ::testing::internal::CaptureStdout();
  EXPECT_EQ(run_service<ExampleService>(2, argv.data()), 0);
  EXPECT_THAT(::testing::internal::GetCapturedStdout(),
              ::testing::StartsWith("slammot-other-store "));
}

TEST_F(RunService, PrintsTheSettingsInEffect) {
  EXPECT_EQ(run({"--config", file("map_store { max_database_mb: 25 }"), "--print-config"}).out,
            "map_store {\n  max_database_mb: 25  # Space.\n}\n");
}

TEST_F(RunService, ChecksSettingsAndLeaves) {
  const Ran ran = run({"--profile", "urban", "--config", file("map_store { max_database_mb: 25 }"),
                       "--check-config"});
  EXPECT_EQ(ran.exit_code, 0);
  EXPECT_EQ(ran.out + ran.err, "");
}

TEST_F(RunService, RefusesAFaultySettingWithOneLineThatSaysWhere) {
  const std::string path = file("map_store {\n  max_database: 25\n}");
  const Ran ran = run({"--config", path, "--check-config"});
  EXPECT_EQ(ran.exit_code, kExitUsage);
  EXPECT_THAT(ran.err, ::testing::StartsWith("slammot-map-store: " + path + ":2:"));
  EXPECT_EQ(std::ranges::count(ran.err, '\n'), 1);
}

TEST_F(RunService, RefusesAnUnknownProfileAndSaysWhichThereAre) {
  const Ran ran = run({"--profile", "moon"});
  EXPECT_EQ(ran.exit_code, kExitUsage);
  EXPECT_THAT(ran.err, ::testing::AllOf(HasSubstr("unknown profile 'moon'"), HasSubstr("urban")));
}

TEST_F(RunService, RefusesNamesAndDomainsThatTheBusCannotHave) {
  EXPECT_EQ(run({"--vehicle", "my car"}).exit_code, kExitUsage);
  EXPECT_EQ(run({"--vehicle", std::string(33, 'x')}).exit_code, kExitUsage);
  EXPECT_EQ(run({"--domain", "231"}).exit_code, kExitUsage);
  EXPECT_EQ(run({"--no-such-option"}).exit_code, kExitUsage);
}

TEST_F(RunService, RefusesSpeedsAndNumbersThatMakeNoSense) {
  for (const char* const speed : {"nan", "-0", "0", "2x", "", "inf", "1e9"}) {
    const Ran ran = run({"--speed", speed, "--check-config"});
    EXPECT_EQ(ran.exit_code, kExitUsage) << speed;
    EXPECT_THAT(ran.err, HasSubstr("is not max or a number from 0.01 to 1000")) << speed;
  }
  EXPECT_EQ(run({"--speed", "max", "--check-config"}).exit_code, 0);
  for (const char* const patience : {"nan", "inf", "-1", "1e300"}) {
    const Ran ran = run({"--patience", patience, "--check-config"});
    EXPECT_EQ(ran.exit_code, kExitUsage) << patience;
    EXPECT_THAT(ran.err, HasSubstr("is not a number from 0.1 to 3600")) << patience;
  }
}

TEST_F(RunService, SaysInOneLineWhyAServiceCannotStart) {
  const auto start = [] {
    const slammot::testing::PrivateBus bus;
    ::setenv("CYCLONEDDS_URI", bus.config.c_str(), 1);
    std::string program = "slammot-map-store", option = "--domain",
                domain = std::to_string(bus.domain_id);
    std::vector<char*> argv = {program.data(), option.data(), domain.data(), nullptr};
    std::exit(run_service<ExampleService>(3, argv.data()));
  };
  EXPECT_EXIT(start(), ::testing::ExitedWithCode(kExitUsage),
              "^slammot-map-store: the disk is on fire\n$");
}

}  // namespace
}  // namespace slammot::app
