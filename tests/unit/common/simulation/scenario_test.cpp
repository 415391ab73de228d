#include "common/simulation/scenario.hpp"

#include <cstdlib>

#include <gtest/gtest.h>

namespace slammot::simulation {
namespace {

TEST(ShippedScenario, IsKnownByEachOfTheNames) {
  for (const std::string& name : scenario_names()) {
    const auto scenario = shipped_scenario(name);
    ASSERT_TRUE(scenario.has_value());
    EXPECT_EQ(scenario->name, name);
    EXPECT_FALSE(scenario->description.empty());
  }
}

TEST(ShippedScenario, IsNotThereForAnotherName) { EXPECT_FALSE(shipped_scenario("atlantis").has_value()); }

TEST(ShippedScenario, TakesAnotherSeed) { EXPECT_EQ(shipped_scenario("demo", 77)->seed, 77U); }

TEST(ShippedScenario, DrivesAlongStreetsThatExist) {
  for (const std::string& name : scenario_names()) {
    const auto scenario = *shipped_scenario(name);
    const auto& route = scenario.route.junctions;
    for (std::size_t i = 0; i < route.size(); ++i) {
      EXPECT_TRUE(route[i].column >= 0 && route[i].column <= scenario.city.blocks_east);
      EXPECT_TRUE(route[i].row >= 0 && route[i].row <= scenario.city.blocks_north);
      if (i == 0) continue;
      EXPECT_EQ(std::abs(route[i].column - route[i - 1].column) + std::abs(route[i].row - route[i - 1].row), 1);
      if (i > 1) EXPECT_FALSE(route[i] == route[i - 2]);  // no turning back in a street
    }
  }
}

}  // namespace
}  // namespace slammot::simulation
