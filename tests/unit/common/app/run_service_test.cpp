#include "common/app/run_service.hpp"

#include <cstdlib>
#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <CLI/CLI.hpp>

#include "tests/support/dds.hpp"
#include "tests/support/temporary_folder.hpp"

namespace slammot::app {
namespace {

using ::testing::HasSubstr;

struct ExampleService {
  struct Settings {
    int max_database_mb = 1;
  };
  static constexpr const char* kName = "map_store";
  static constexpr const char* kPurpose = "Stands for a service.";
  static std::vector<config::BoundStage> stages(Settings& settings) {
    static const config::FieldTable<Settings> table = {
        {"max_database_mb", &Settings::max_database_mb, "Space.", config::kPositive}};
    return {config::bind_stage("map_store", table, settings)};
  }
  static void add_options(CLI::App&, Settings&) {}
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
  EXPECT_NE(run({"--vehicle", "my car"}).exit_code, 0);
  EXPECT_NE(run({"--vehicle", std::string(33, 'x')}).exit_code, 0);
  EXPECT_NE(run({"--domain", "231"}).exit_code, 0);
  EXPECT_NE(run({"--no-such-option"}).exit_code, 0);
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
