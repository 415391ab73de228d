#include "common/simulation/script.hpp"

#include <algorithm>

#include <gtest/gtest.h>

#include "common/simulation/scenario.hpp"
#include "common/simulation/scene.hpp"

namespace slammot::simulation {
namespace {

constexpr double kStep_s = 0.02;

ScenarioConfig scene_of(const std::vector<ScriptedObject>& objects) {
  ScenarioConfig scenario;
  scenario.place = Place::script;
  scenario.warm_up_s = 0.0;
  scenario.script.vehicle.way = {{0.0, 0.0}, {500.0, 0.0}};
  scenario.script.vehicle.speed = {{0.0, 5.0}};
  scenario.script.objects = objects;
  return scenario;
}

ScriptedObject car(const std::vector<PlaceInWorld>& way, const std::vector<SpeedAt>& speed) {
  ScriptedObject object;
  object.way = way;
  object.speed = speed;
  return object;
}

void advance(Scene& scene, double duration_s) {
  for (double time_s = 0.0; time_s < duration_s - 0.5 * kStep_s; time_s += kStep_s)
    scene.advance(kStep_s);
}

TEST(ScriptScene, DrivesAlongTheWayAtTheGivenSpeeds) {
  const auto scene = make_script_scene(
      scene_of({car({{10.0, 4.0}, {500.0, 4.0}}, {{0.0, 10.0}, {2.0, 10.0}, {4.0, 0.0}})}));
  EXPECT_EQ(scene->vehicle().speed_mps, 5.0);  // at once: the world did not begin with the
                                               // recording
  advance(*scene, 2.0);
  EXPECT_NEAR(scene->vehicle().world_from_object.x_m, 10.0, 1e-6);
  EXPECT_NEAR(scene->others()[0].world_from_object.x_m, 30.0, 1e-6);
  EXPECT_NEAR(scene->others()[0].world_from_object.y_m, 4.0, 1e-9);
  advance(*scene, 4.0);
  EXPECT_NEAR(scene->others()[0].world_from_object.x_m, 40.0, 0.15);
  EXPECT_EQ(scene->others()[0].speed_mps, 0.0);
}

TEST(ScriptScene, StandsAtTheEndOfTheWay) {
  const auto scene = make_script_scene(scene_of({car({{0.0, 4.0}, {9.0, 4.0}}, {{0.0, 10.0}})}));
  advance(*scene, 3.0);
  EXPECT_NEAR(scene->others()[0].world_from_object.x_m, 9.0, 0.21);
  EXPECT_EQ(scene->others()[0].speed_mps, 0.0);
}

TEST(ScriptScene, TakesAwayWhatHasLeft) {
  ScriptedObject parked = car({{10.0, 4.0}}, {});
  parked.heading_rad = 0.5;
  parked.until_s = 1.0;
  const auto scene = make_script_scene(scene_of({parked}));
  EXPECT_FALSE(scene->others()[0].outline_in_object.segments.empty());
  EXPECT_EQ(scene->others()[0].world_from_object.heading_rad, 0.5);
  advance(*scene, 1.1);
  EXPECT_TRUE(scene->others()[0].outline_in_object.segments.empty());
}

TEST(ScriptScene, MakesCopiesThatDifferWithinBounds) {
  ScriptedObject walker = car({{10.0, 0.0}, {10.0, 50.0}}, {{0.0, 1.0}});
  walker.kind = ObjectClass::pedestrian;
  walker.copies = 20;
  walker.ahead_variation_m = 3.0;
  walker.sideways_variation_m = 1.0;
  walker.speed_variation = 0.2;
  const auto scene = make_script_scene(scene_of({walker}));
  ASSERT_EQ(scene->others().size(), 20U);
  std::vector<double> places_m;
  for (const MovingObject& person : scene->others()) {
    EXPECT_LE(std::abs(person.world_from_object.x_m - 10.0), 1.0);
    EXPECT_LE(person.world_from_object.y_m, 3.0);
    EXPECT_LE(std::abs(person.speed_mps - 1.0), 0.2);
    places_m.push_back(person.world_from_object.y_m);
  }
  const auto [first, last] = std::minmax_element(places_m.begin(), places_m.end());
  EXPECT_GT(*last - *first, 1.0);
}

ScriptedObject pedestrian(const std::vector<PlaceInWorld>& way, double mps) {
  ScriptedObject object = car(way, {{0.0, mps}});
  object.kind = ObjectClass::pedestrian;
  return object;
}

TEST(ScriptScene, LetsPedestriansGiveWayToEachOtherAndReturnToTheirWays) {
  const auto scene = make_script_scene(scene_of(
      {pedestrian({{10.0, 5.0}, {30.0, 5.0}}, 1.0), pedestrian({{20.0, 5.1}, {0.0, 5.1}}, 1.5)}));
  double least_m = 1e9;
  for (int i = 0; i < 600; ++i) {
    scene->advance(kStep_s);
    const std::vector<MovingObject> people = scene->others();
    least_m = std::min(least_m, (people[0].world_from_object.translation_m() -
                                 people[1].world_from_object.translation_m())
                                    .norm());
  }
  EXPECT_GT(least_m, 0.5);
  EXPECT_NEAR(scene->others()[0].world_from_object.y_m, 5.0, 0.05);
  EXPECT_NEAR(scene->others()[1].world_from_object.y_m, 5.1, 0.05);
  EXPECT_NEAR(scene->others()[0].world_from_object.x_m, 22.0, 1.0);
}

TEST(ScriptScene, LeavesPedestriansWhoMeetNobodyToTheScript) {
  const auto alone = make_script_scene(scene_of({pedestrian({{10.0, 5.0}, {30.0, 8.0}}, 1.3)}));
  const auto beside = make_script_scene(scene_of(
      {pedestrian({{10.0, 5.0}, {30.0, 8.0}}, 1.3), pedestrian({{10.0, 9.0}, {30.0, 9.0}}, 1.0)}));
  for (const auto& scene : {&alone, &beside}) advance(**scene, 8.0);
  EXPECT_EQ(alone->others()[0].world_from_object, beside->others()[0].world_from_object);
}

TEST(ScriptScene, LeadsPedestriansRoundPosts) {
  ScenarioConfig scenario = scene_of({pedestrian({{10.0, 5.0}, {40.0, 5.0}}, 1.3)});
  ScriptedRow post;
  post.from = {16.0, 5.05};
  scenario.script.rows.push_back(post);
  const auto scene = make_script_scene(scenario);
  for (int i = 0; i < 600; ++i) {
    scene->advance(kStep_s);
    EXPECT_GT((scene->others()[0].world_from_object.translation_m() - geometry::Vector2(16.0, 5.05))
                  .norm(),
              0.4);
  }
  EXPECT_GT(scene->others()[0].world_from_object.x_m, 22.0);
}

TEST(ScriptScene, LetsEachVehicleWithAScannerSeeTheOther) {
  ScriptedObject other = car({{100.0, 4.0}, {0.0, 4.0}}, {{0.0, 7.0}});
  other.carries_scanner = true;
  ScenarioConfig scenario = scene_of({other});
  const auto first = make_script_scene(scenario);
  scenario.ride = 1;
  const auto second = make_script_scene(scenario);
  for (const auto& scene : {&first, &second}) advance(**scene, 2.0);
  EXPECT_EQ(first->vehicle().world_from_object, second->others()[0].world_from_object);
  EXPECT_EQ(second->vehicle().world_from_object, first->others()[0].world_from_object);
  EXPECT_NE(first->others()[0].id, second->others()[0].id);
}

TEST(BuildScript, PutsFrontsToTheLeftOfTheWayAndLeavesGaps) {
  ScriptConfig script;
  script.fronts.push_back({{{0.0, 5.0}, {300.0, 5.0}}, 6.0, 1.5, 0.3});
  const Outline outline = build_script(script, 1);
  ASSERT_GT(outline.segments.size(), 20U);
  double covered_m = 0.0;
  for (const Segment& segment : outline.segments) {
    for (const double y_m : {segment.a.y(), segment.b.y()}) {
      EXPECT_GE(y_m, 5.0);
      EXPECT_LE(y_m, 6.5);
    }
    covered_m += std::abs((segment.b - segment.a).x());
  }
  EXPECT_GT(covered_m, 150.0);
  EXPECT_LT(covered_m, 270.0);
  script.fronts[0].depth_m = 0.0;
  script.fronts[0].gap_share = 0.0;
  EXPECT_EQ(build_script(script, 1).segments.size(), 1U);
}

TEST(BuildScript, PutsThingsInARow) {
  ScriptConfig script;
  script.rows.push_back({RowOf::bush, {0.0, 2.0}, {20.0, 2.0}, 5.0, 0.0, 0.7});
  script.rows.push_back({RowOf::post, {3.0, 3.0}, {}, 0.0, 0.0, 0.1});
  const Outline outline = build_script(script, 1);
  ASSERT_EQ(outline.circles.size(), 6U);
  EXPECT_EQ(outline.circles[4].centre, geometry::Vector2(20.0, 2.0));
  EXPECT_EQ(outline.circles[4].material, Material::foliage);
  EXPECT_EQ(outline.circles[5].centre, geometry::Vector2(3.0, 3.0));
}

}  // namespace
}  // namespace slammot::simulation
