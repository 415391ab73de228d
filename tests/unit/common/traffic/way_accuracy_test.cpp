#include "common/traffic/way_accuracy.hpp"

#include <gtest/gtest.h>

namespace slammot::traffic {
namespace {

using geometry::Vector2;

constexpr std::size_t kLane = 0;
constexpr std::size_t kWalkway = 2;

Way way(const Vector2& from_m, const Vector2& to_m, Mover mover = Mover::kVehicle) {
  Way made;
  made.mover = mover;
  made.points_in_map_m = {from_m, to_m};
  made.confidence = 0.5;
  return made;
}

TrueStep step(const Vector2& from_m, const Vector2& to_m, Mover mover = Mover::kVehicle) {
  return {mover, from_m, to_m, true};
}

TEST(WayAccuracy, MeasuresTheShareOfTheWayThatIsOnALane) {
  const auto accuracy = judge({way({0.0, 0.5}, {30.0, 0.5})}, {step({0.0, 0.0}, {40.0, 0.0})}, {});
  EXPECT_NEAR(accuracy[kLane].recall(), 0.75, 0.03);
  EXPECT_NEAR(accuracy[kLane].precision(), 1.0, 1e-9);
}

TEST(WayAccuracy, MeasuresTheShareOfALaneThatSomethingTook) {
  const auto accuracy = judge({way({0.0, 0.0}, {40.0, 0.0})}, {step({0.0, 0.0}, {10.0, 0.0})}, {});
  EXPECT_NEAR(accuracy[kLane].recall(), 1.0, 1e-9);
  EXPECT_NEAR(accuracy[kLane].precision(), 0.25, 0.03);
}

TEST(WayAccuracy, ExpectsLanesInTheDirectionOfTravelAndWalkwaysInEither) {
  for (const Mover mover : {Mover::kVehicle, Mover::kPedestrian}) {
    const auto accuracy =
        judge({way({40.0, 0.0}, {0.0, 0.0}, mover)}, {step({0.0, 0.0}, {40.0, 0.0}, mover)}, {});
    const std::size_t kind = mover == Mover::kVehicle ? kLane : kWalkway;
    EXPECT_NEAR(accuracy[kind].recall(), mover == Mover::kVehicle ? 0.0 : 1.0, 1e-9);
  }
}

TEST(WayAccuracy, RefusesWhatIsTooFarOrTooOblique) {
  const TrueStep truth = step({0.0, 0.0}, {40.0, 0.0});
  EXPECT_EQ(judge({way({0.0, 1.2}, {40.0, 1.2})}, {truth}, {})[kLane].found_m, 0.0);
  EXPECT_EQ(judge({way({19.8, -0.25}, {20.2, 0.25})}, {truth}, {})[kLane].found_m, 0.0);
}

TEST(WayAccuracy, ExpectsOnlyWhatWasInView) {
  TrueStep hidden = step({0.0, 0.0}, {40.0, 0.0});
  hidden.is_in_view = false;
  const auto accuracy = judge({way({0.0, 0.0}, {40.0, 0.0})}, {hidden}, {});
  EXPECT_EQ(accuracy[kLane].travelled_m, 0.0);
  EXPECT_NEAR(accuracy[kLane].precision(), 1.0, 1e-9);
}

TEST(WayAccuracy, LeavesOutDoubtfulWays) {
  WayRule rule;
  rule.least_confidence = 0.6;
  const auto accuracy =
      judge({way({0.0, 0.0}, {40.0, 0.0})}, {step({0.0, 0.0}, {40.0, 0.0})}, rule);
  EXPECT_EQ(accuracy[kLane].length_m, 0.0);
  EXPECT_EQ(accuracy[kLane].recall(), 0.0);
}

}  // namespace
}  // namespace slammot::traffic
