#include "common/simulation/office_plan.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "common/simulation/ray_caster.hpp"
#include "common/simulation/robot.hpp"
#include "common/simulation/scenario.hpp"
#include "common/simulation/scene.hpp"
#include "services/simulator/scenario_files.hpp"
#include "tests/support/matchers.hpp"

namespace slammot::simulation {
namespace {

using geometry::Pose2;
using geometry::Vector2;
using slammot::testing::PoseNear;

TEST(BuildOffice, LeavesEveryCorridorFreeFromEndToEnd) {
  const OfficePlan plan = build_office(OfficeConfig{}, 4);
  const RayCaster caster(plan.outline_in_world);
  ASSERT_FALSE(plan.corridors.ways.empty());
  for (std::size_t from = 0; from < plan.corridors.ways.size(); ++from) {
    for (const WalkGraph::Way& way : plan.corridors.ways[from]) {
      const Vector2 start = plan.corridors.places_in_world[from];
      const Vector2 ahead =
          plan.corridors.places_in_world[static_cast<std::size_t>(way.to)] - start;
      EXPECT_GT(caster.cast(start, ahead.normalized(), 100.0).range_m, ahead.norm());
    }
  }
}

TEST(BuildOffice, WallsInEveryDirection) {
  const OfficePlan plan = build_office(OfficeConfig{}, 4);
  const RayCaster caster(plan.outline_in_world);
  ASSERT_FALSE(plan.corridors.places_in_world.empty());
  for (const Vector2& place : plan.corridors.places_in_world) {
    for (double heading_rad = -3.1; heading_rad < 3.1; heading_rad += 0.01) {
      EXPECT_LT(caster.cast(place, {std::cos(heading_rad), std::sin(heading_rad)}, 100.0).range_m,
                100.0);
    }
  }
}

TEST(Robot, GetsToTheEndOfItsWayAndStops) {
  Robot robot({{0.0, 0.0}, {10.0, 0.0}, {10.0, 5.0}}, RobotConfig{});
  for (int i = 0; i < 400; ++i) robot.advance(0.1, {});
  EXPECT_THAT(robot.world_from_base(), PoseNear(Pose2{10.0, 5.0, std::acos(0.0)}, 0.05));
  EXPECT_NEAR(robot.speed_mps(), 0.0, 0.05);
}

TEST(Robot, WaitsForSomebodyInItsWay) {
  Robot robot({{0.0, 0.0}, {10.0, 0.0}}, RobotConfig{});
  MovingObject person;
  person.world_from_object = {3.0, 0.1, 0.0};
  for (int i = 0; i < 200; ++i) robot.advance(0.1, {person});
  EXPECT_EQ(robot.speed_mps(), 0.0);
  EXPECT_LT(robot.world_from_base().x_m, 2.5);
}

class OfficeScenario : public ::testing::TestWithParam<const char*> {};

TEST_P(OfficeScenario, KeepsRobotAndPeopleApartAndTheRobotOnItsWay) {
  const ScenarioConfig scenario = *simulator::load_scenario(GetParam());
  const auto scene = make_office_scene(scenario);
  double nearest_m = 1e9;
  double travelled_m = 0.0;
  for (double time_s = 0.0; time_s < scenario.duration_s; time_s += 0.1) {
    scene->advance(0.1);
    const MovingObject robot = scene->vehicle();
    travelled_m += robot.speed_mps * 0.1;
    for (const MovingObject& person : scene->others()) {
      const Vector2 apart =
          person.world_from_object.translation_m() - robot.world_from_object.translation_m();
      nearest_m = std::min(nearest_m, apart.norm());
    }
  }
  EXPECT_GT(nearest_m, 0.25);  // the robot's radius
  EXPECT_GT(travelled_m, 0.4 * scenario.duration_s);
}

INSTANTIATE_TEST_SUITE_P(Shipped, OfficeScenario, ::testing::Values("office", "corridor"),
                         [](const auto& info) { return std::string(info.param); });

}  // namespace
}  // namespace slammot::simulation
