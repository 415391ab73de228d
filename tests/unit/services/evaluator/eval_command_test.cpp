#include "services/evaluator/eval_command.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "tests/support/temporary_folder.hpp"
#include "tests/unit/services/evaluator/files.hpp"

namespace slammot::evaluator {
namespace {

using ::testing::HasSubstr;

class EvalCommand : public ::testing::Test {
 protected:
  EvalCommand() {
    write(folder_ / "online.tum", straight_tum(0.0));
    write(folder_ / "trajectory.tum", straight_tum(0.0));
    write(folder_ / "drive.tum", straight_tum(100.0));
  }

  int run(const std::string& more = "") {
    CLI::App app;
    int exit_code = 0;
    add_eval_command(app, exit_code);
    app.parse("eval --result " + folder_.path().string() + " --truth " +
              (folder_ / "drive").string() + more);
    return exit_code;
  }

  testing::TemporaryFolder folder_;
};

TEST_F(EvalCommand, PrintsATableAndWritesEveryFigure) {
  ::testing::internal::CaptureStdout();
  EXPECT_EQ(run(), 0);
  EXPECT_THAT(::testing::internal::GetCapturedStdout(), HasSubstr("ATE, rigidly aligned"));
  std::ifstream file(folder_ / "evaluation.json");
  const auto json = nlohmann::json::parse(file);
  EXPECT_EQ(json["trajectory"]["ate_m"]["count"], 301);
  EXPECT_EQ(json["trajectory"]["over"]["10_m"]["rpe_m"]["rmse"], 0.0);
}

TEST_F(EvalCommand, WritesTheRowsOfBoxesWhereAsked) {
  write(folder_ / "drive.objects.csv", car_ahead_csv(100.0));
  write(folder_ / "tracks.csv", tracks_csv(0.0, 0.5));
  ::testing::internal::CaptureStdout();
  EXPECT_EQ(run(), 0);
  EXPECT_FALSE(std::filesystem::exists(folder_ / "vehicle_boxes.csv"));
  EXPECT_EQ(run(" --boxes"), 0);
  ::testing::internal::GetCapturedStdout();
  std::ifstream file(folder_ / "vehicle_boxes.csv");
  std::string header;
  std::string row;
  std::getline(file, header);
  std::getline(file, row);
  EXPECT_THAT(header, HasSubstr("stamp_s,object,class,track,distance_m"));
  EXPECT_THAT(row, HasSubstr(",car,7,"));
  EXPECT_THAT(row,
              HasSubstr(",10.00,20,0.000,10.000,4.500,1.800,4.500,1.800,0.5652,0.0000,0.5000,"));
}

TEST_F(EvalCommand, FailsWithOneLine) {
  write(folder_ / "drive.tum", straight_tum(100.0, 5000.0));
  ::testing::internal::CaptureStderr();
  EXPECT_EQ(run(), 1);
  const std::string said = ::testing::internal::GetCapturedStderr();
  EXPECT_THAT(said, HasSubstr("slammot: the clocks do not overlap"));
  EXPECT_EQ(std::count(said.begin(), said.end(), '\n'), 1);
}

}  // namespace
}  // namespace slammot::evaluator
