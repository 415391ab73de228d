#include "services/simulator/simulate_command.hpp"

#include <sstream>

#include <gtest/gtest.h>

namespace slammot::simulator {
namespace {

TEST(Simulate, ListsTheScenarios) {
  std::ostringstream out, err;
  EXPECT_EQ(simulate({.list = true, .scenario = "", .seed = {}, .output = ""}, out, err), 0);
  EXPECT_NE(out.str().find("demo"), std::string::npos);
}

TEST(Simulate, RefusesAnUnknownScenarioInOneLine) {
  std::ostringstream out, err;
  EXPECT_NE(simulate({.list = false, .scenario = "atlantis", .seed = {}, .output = "x"}, out, err), 0);
  EXPECT_EQ(err.str(), "slammot simulate: no scenario is named 'atlantis'; --list names them\n");
}

TEST(Simulate, AsksForAFolder) {
  std::ostringstream out, err;
  EXPECT_NE(simulate({.list = false, .scenario = "demo", .seed = {}, .output = ""}, out, err), 0);
  EXPECT_NE(err.str().find("--output"), std::string::npos);
}

}  // namespace
}  // namespace slammot::simulator
