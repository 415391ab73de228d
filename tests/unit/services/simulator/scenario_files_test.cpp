#include "services/simulator/scenario_files.hpp"

#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/config/overlay.hpp"
#include "common/config/profiles.hpp"
#include "services/simulator/scenario_fields.hpp"
#include "tests/support/temporary_folder.hpp"

namespace slammot::simulator {
namespace {

using simulation::ScenarioConfig;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

TEST(ScenarioFields, MatchTheProto) {
  ScenarioConfig scenario;
  EXPECT_THAT(
      config::differences_from_proto(config::bind_stage("Scenario", scenario_fields(), scenario)),
      IsEmpty());
}

TEST(ShippedScenario, CanBeLoadedByName) {
  ASSERT_THAT(scenario_names(),
              ::testing::IsSupersetOf({"block", "city", "corridor", "office", "quiet"}));
  for (const std::string& name : scenario_names()) {
    const auto scenario = load_scenario(name);
    ASSERT_TRUE(scenario) << scenario.error().message;
    EXPECT_EQ(scenario->name, name);
    EXPECT_FALSE(scenario->description.empty()) << name;
    EXPECT_TRUE(config::find_profile(scenario->profile)) << name;
  }
}

TEST(ShippedScenario, HasOneForEachDifficultyOfTheThesis) {
  const std::vector<std::string> names = {
      "car_ahead",    "far_crossing",     "occluded_car", "move_stop_move",
      "pedestrians",  "bus_stop",         "truck",        "crowd",
      "hard_braking", "uphill",           "long_wall",    "empty_lot",
      "bushes",       "parked_cars_gone", "surrounded",   "two_vehicles"};
  for (const std::string& name : names) {
    const auto scenario = load_scenario(name);
    ASSERT_TRUE(scenario) << scenario.error().message;
    EXPECT_EQ(scenario->place, simulation::Place::script) << name;
    EXPECT_GE(scenario->duration_s, 10.0) << name;
    EXPECT_LE(scenario->duration_s, 60.0) << name;
  }
}

TEST(ShippedScenario, AcceptsAnotherSeed) { EXPECT_EQ(load_scenario("block", 77)->seed, 77U); }

TEST(ShippedScenario, IsNotFoundByAnotherName) {
  EXPECT_THAT(load_scenario("atlantis").error().message,
              HasSubstr("no scenario is named 'atlantis'"));
}

class ScenarioFile : public ::testing::Test {
 protected:
  files::Result<ScenarioConfig> load(const std::string& text) const {
    const std::string path = folder_ / "mine.textproto";
    std::ofstream(path) << text;
    return load_scenario(path);
  }
  std::string fault_of(const std::string& text) const {
    const auto scenario = load(text);
    return scenario ? "none" : scenario.error().message;
  }
  testing::TemporaryFolder folder_;
};

TEST_F(ScenarioFile, OverridesTheDefaults) {
  const auto scenario = load(R"(
    place: SCRIPT
    script {
      vehicle { way { x_m: 1 y_m: 2 } }
      objects { kind: BUS way [{ x_m: 3 }, { x_m: 4 }] speed { at_s: 1 mps: 2 } }
      objects { kind: PEDESTRIAN way { y_m: 5 } }
      rows { of: BUSH from { x_m: 6 } }
    })");
  ASSERT_TRUE(scenario) << scenario.error().message;
  EXPECT_EQ(scenario->name, "mine");
  EXPECT_EQ(scenario->place, simulation::Place::script);
  EXPECT_EQ(scenario->duration_s, ScenarioConfig{}.duration_s);
  ASSERT_EQ(scenario->script.objects.size(), 2U);
  EXPECT_EQ(scenario->script.objects[0].kind, simulation::ObjectClass::bus);
  ASSERT_EQ(scenario->script.objects[0].way.size(), 2U);
  EXPECT_EQ(scenario->script.objects[0].way[1].x_m, 4.0);
  EXPECT_EQ(scenario->script.objects[0].speed.at(0).mps, 2.0);
  EXPECT_EQ(scenario->script.objects[1].kind, simulation::ObjectClass::pedestrian);
  EXPECT_EQ(scenario->script.rows.at(0).of, simulation::RowOf::bush);
  EXPECT_EQ(scenario->script.rows.at(0).from.x_m, 6.0);
}

TEST_F(ScenarioFile, IsRejectedWithThePlaceOfItsFault) {
  EXPECT_THAT(fault_of("place: ATLANTIS"), HasSubstr("mine.textproto:1:"));
  EXPECT_THAT(fault_of("\ncity { blocks: 3 }"), HasSubstr("mine.textproto:2:"));
  EXPECT_THAT(fault_of("duration_s: -1"),
              HasSubstr("mine.textproto:1:1: Scenario.duration_s = -1 is not above 0"));
  EXPECT_THAT(
      fault_of("script {\n objects { way { x_m: 1 } }\n objects {\n  copies: 0 } }"),
      HasSubstr("mine.textproto:4:3: Scenario.script.objects.copies = 0 is outside [1, 500]"));
}

TEST_F(ScenarioFile, IsRejectedIfItIsInvalid) {
  EXPECT_THAT(fault_of("route { junctions [{ column: 0 }, { column: 9 }] }"),
              HasSubstr("the vehicle's route leaves the city"));
  EXPECT_THAT(fault_of("route { junctions [{ column: 0 }, { column: 2 }, { column: 0 }] }"),
              HasSubstr("turns back in a street"));
  EXPECT_THAT(fault_of("place: OFFICE"), HasSubstr("the robot's path"));
  EXPECT_THAT(fault_of("place: SCRIPT"), HasSubstr("the vehicle has no path"));
  EXPECT_THAT(fault_of("terrain [{ x_m: 2 }, { x_m: 1 }]"), HasSubstr("from west to east"));
  EXPECT_THAT(fault_of("scanner { rate_hz: 75 sweep_s: 0.02 }"),
              HasSubstr("is longer than its period"));
}

}  // namespace
}  // namespace slammot::simulator
