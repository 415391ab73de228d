#include "services/evaluator/way_evaluation.hpp"

#include <gtest/gtest.h>

namespace slammot::evaluator {
namespace {

metrics::TrueObject object_at(double x_m, int points, const char* object_class = "car") {
  metrics::TrueObject object;
  object.object_class = object_class;
  object.world_from_object = {x_m, 0.0, 0.0};
  object.speed_mps = 10.0;
  object.points = points;
  return object;
}

/// An object that drives along x, ten scans a second; hidden from 20 m on.
std::vector<metrics::Scene> scenes_of(const char* object_class = "car") {
  std::vector<metrics::Scene> scenes;
  for (int scan = 0; scan <= 40; ++scan) {
    metrics::Scene scene;
    scene.stamp_ns = scan * 100'000'000LL;
    if (scan <= 20) scene.objects.push_back(object_at(scan, 9, object_class));
    else scene.hidden_objects.push_back(object_at(scan, 0, object_class));
    scenes.push_back(scene);
  }
  return scenes;
}

TEST(WayEvaluation, TakesStepsFromTruthAndKnowsWhatWasInView) {
  const auto steps = true_steps(scenes_of(), {5.0, 0.0, 0.0}, {});
  ASSERT_EQ(steps.size(), 40U);
  EXPECT_NEAR(steps[0].from_m.x(), 5.0, 1e-9);
  EXPECT_NEAR(steps[0].to_m.x(), 6.0, 1e-9);
  EXPECT_TRUE(steps[19].is_in_view);
  EXPECT_FALSE(steps[20].is_in_view);
}

TEST(WayEvaluation, DoesNotJoinPlacesOfTimesThatAreFarApart) {
  auto scenes = scenes_of();
  scenes.erase(scenes.begin() + 5, scenes.begin() + 16);
  const auto steps = true_steps(scenes, {}, {});
  EXPECT_EQ(steps.size(), 4U + 24U);
}

TEST(WayEvaluation, ComparesWaysOfTheSameKind) {
  traffic::Way lane;
  lane.points_in_map_m = {{0.0, 0.0}, {40.0, 0.0}};
  lane.confidence = 0.5;
  for (const char* object_class : {"car", "bus", "pedestrian", "bicycle"}) {
    const auto evaluation = evaluate_ways({lane}, true_steps(scenes_of(object_class), {}, {}));
    const bool is_vehicle =
        std::string(object_class) == "car" || std::string(object_class) == "bus";
    EXPECT_NEAR(evaluation.all[0].precision(), is_vehicle ? 1.0 : 0.0, 1e-9) << object_class;
    EXPECT_NEAR(evaluation.all[0].recall(), is_vehicle ? 1.0 : 0.0, 1e-9) << object_class;
    EXPECT_EQ(evaluation.confident[0].length_m, 0.0);
  }
}

}  // namespace
}  // namespace slammot::evaluator
