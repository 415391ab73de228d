#include "services/simulator/simulate_command.hpp"

#include <sstream>

#include <gtest/gtest.h>

#include "tests/support/temporary_folder.hpp"

namespace slammot::simulator {
namespace {

TEST(Simulate, ListsTheScenarios) {
  std::ostringstream out, err;
  EXPECT_EQ(simulate({.list = true, .scenario = "", .seed = {}, .output = ""}, out, err), 0);
  EXPECT_NE(out.str().find("block"), std::string::npos);
}

TEST(Simulate, RejectsAnUnknownScenarioInOneLine) {
  std::ostringstream out, err;
  EXPECT_EQ(simulate({.list = false, .scenario = "atlantis", .seed = {}, .output = "x"}, out, err),
            2);
  EXPECT_EQ(
      err.str(),
      "slammot simulate: no scenario is named 'atlantis'; slammot simulate --list names them\n");
}

TEST(Simulate, WritesADriveForEachVehicleWithAScanner) {
  const testing::TemporaryFolder folder;
  std::ostringstream out, err;
  ASSERT_EQ(
      simulate(
          {.list = false, .scenario = "two_vehicles", .seed = {}, .output = folder.path().string()},
          out, err),
      0)
      << err.str();
  for (const char* file : {"two_vehicles.log", "two_vehicles.tum", "two_vehicles.2.log",
                           "two_vehicles.2.tum", "two_vehicles.2.objects.csv"}) {
    EXPECT_TRUE(std::filesystem::exists(folder.path() / file)) << file;
  }
}

TEST(Simulate, RequiresAFolder) {
  std::ostringstream out, err;
  EXPECT_EQ(simulate({.list = false, .scenario = "block", .seed = {}, .output = ""}, out, err), 2);
  EXPECT_NE(err.str().find("--output"), std::string::npos);
}

}  // namespace
}  // namespace slammot::simulator
