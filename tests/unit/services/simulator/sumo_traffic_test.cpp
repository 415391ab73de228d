#include "services/simulator/sumo_traffic.hpp"

#include <fstream>
#include <map>
#include <numbers>
#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/simulation/drive.hpp"
#include "common/simulation/scene.hpp"
#include "services/simulator/scenario_files.hpp"
#include "tests/support/temporary_folder.hpp"

namespace slammot::simulator {
namespace {

using ::testing::HasSubstr;

constexpr const char* kTraffic = R"(<?xml version="1.0"?>
<fcd-export>
  <timestep time="100.0">
    <vehicle id="ego" x="50.0" y="20.0" angle="90.0" type="passenger" speed="10.0" pos="1" lane="a_0" slope="0"/>
    <vehicle id="line7" x="80.0" y="20.0" angle="0.0" type="city_bus" speed="0.0"/>
  </timestep>
  <timestep time="101.0">
    <vehicle id="ego" x="60.0" y="20.0" angle="90.0" type="passenger" speed="12.0"/>
    <person id="anna" x="70.0" y="25.0" angle="180.0" speed="1.2"/>
  </timestep>
</fcd-export>)";

class SumoTraffic : public ::testing::Test {
 protected:
  std::string write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name) << text;
    return folder_ / name;
  }
  testing::TemporaryFolder folder_;
};

TEST_F(SumoTraffic, IsReadWithItsClassesPlacesAndTimes) {
  const auto read = read_sumo_traffic(write("fcd.xml", kTraffic));
  ASSERT_TRUE(read) << read.error().message;
  ASSERT_EQ(read->size(), 3U);
  const auto& [ego, bus, person] = std::tie((*read)[0], (*read)[1], (*read)[2]);
  EXPECT_EQ(ego.name, "ego");
  EXPECT_EQ(bus.kind, simulation::ObjectClass::bus);
  EXPECT_EQ(person.kind, simulation::ObjectClass::pedestrian);
  EXPECT_EQ(ego.places.at(1).at_s, 1.0);
  EXPECT_NEAR(ego.places[0].world_from_object.x_m, 50.0 - 2.2, 1e-9);  // half a car behind its
                                                                       // bumper
  EXPECT_NEAR(ego.places[0].world_from_object.heading_rad, 0.0, 1e-9);
  EXPECT_NEAR(bus.places.at(0).world_from_object.y_m, 20.0 - 6.0, 1e-9);
  EXPECT_NEAR(bus.places[0].world_from_object.heading_rad, 0.5 * std::numbers::pi, 1e-9);
  EXPECT_NEAR(person.places.at(0).world_from_object.y_m, 25.0, 1e-9);
}

TEST_F(SumoTraffic, TakesPartInAScenarioAndMayCarryTheScanner) {
  write("fcd.xml", kTraffic);
  const auto scenario = load_scenario(write(
      "mine.textproto", "place: SCRIPT warm_up_s: 0 sumo_fcd: 'fcd.xml' sumo_vehicle: 'ego'"));
  ASSERT_TRUE(scenario) << scenario.error().message;
  const auto scene = make_script_scene(*scenario);
  scene->advance(0.5);
  EXPECT_NEAR(scene->vehicle().world_from_object.x_m, 55.0 - 2.2, 1e-9);
  EXPECT_NEAR(scene->vehicle().speed_mps, 11.0, 1e-9);
  ASSERT_EQ(scene->others().size(), 2U);
  EXPECT_TRUE(scene->others()[1].outline_in_object.circles.empty());  // anna appears later
  scene->advance(0.5);
  EXPECT_FALSE(scene->others()[1].outline_in_object.circles.empty());
  EXPECT_TRUE(scene->others()[0].outline_in_object.segments.empty());  // and the bus has left
}

/// Written by SUMO 1.15 as docs/scenarios.md describes.
TEST_F(SumoTraffic, OfARealRunIsSimulated) {
  const auto scenario = load_scenario(SLAMMOT_SUMO_FOLDER "/junction.textproto");
  ASSERT_TRUE(scenario) << scenario.error().message;
  std::map<simulation::ObjectClass, int> classes;
  for (const auto& object : scenario->script.recorded) ++classes[object.kind];
  using simulation::ObjectClass;
  EXPECT_EQ(classes, (std::map<ObjectClass, int>{{ObjectClass::car, 7},
                                                 {ObjectClass::truck, 1},
                                                 {ObjectClass::bus, 1},
                                                 {ObjectClass::bicycle, 1},
                                                 {ObjectClass::pedestrian, 2}}));
  simulation::Drive drive(*scenario);
  std::set<ObjectClass> seen;
  double way_m = 0.0;
  std::optional<geometry::Pose2> last;
  while (const auto scan = drive.next()) {
    for (const auto& object : scan->objects) seen.insert(object.kind);
    if (last) way_m += (scan->world_from_base.translation_m() - last->translation_m()).norm();
    last = scan->world_from_base;
  }
  EXPECT_GE(seen.size(), 4U);
  EXPECT_NEAR(way_m, 200.0, 60.0);
}

TEST_F(SumoTraffic, IsRejectedWithTheLineOfItsFault) {
  const auto fault_of = [&](const std::string& text) {
    const auto read = read_sumo_traffic(write("bad.xml", text));
    return read ? "none" : read.error().message;
  };
  EXPECT_THAT(fault_of("<fcd-export>\n<timestep time='1'>\n<vehicle id='a' x='1'/>"),
              HasSubstr("bad.xml:3: a vehicle without"));
  EXPECT_THAT(fault_of("<fcd-export>\n</fcd>"), HasSubstr("bad.xml:2: mismatched tag"));
  EXPECT_THAT(fault_of("<fcd-export><timestep time='2'/>\n<timestep time='1'/></fcd-export>"),
              HasSubstr("bad.xml:2: a timestep whose time"));
  EXPECT_THAT(fault_of("<fcd-export/>"), HasSubstr("no vehicle and no person"));
  EXPECT_THAT(read_sumo_traffic(folder_ / "missing.xml").error().message,
              HasSubstr("cannot be read"));
}

}  // namespace
}  // namespace slammot::simulator
