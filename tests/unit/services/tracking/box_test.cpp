#include "services/tracking/box.hpp"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "services/tracking/tracking_config.hpp"
#include "tests/support/box_echoes.hpp"

namespace slammot::tracking {
namespace {

using Eigen::Vector2d;
using testing::echoes_of;
using testing::observation_of;

const TrackingConfig kConfig;

/// A car of which only the flank is seen, at heading 0 before a laser at the origin that lies
/// beyond its low end.
Box car_of_unknown_length() {
  Box box;
  box.is_oriented = true;
  return with_likely_sizes(box, kConfig);
}

TEST(Box, IsLongerThanACarBehindABackThatIsWiderThanACars) {
  const auto points = echoes_of({20.0, 0.0}, 12.0, 2.5);
  const Box box = likely_box(M_PI / 2.0, observation_of(points), kConfig);
  EXPECT_TRUE(box.kind == Kind::kTruck || box.kind == Kind::kBus);
  EXPECT_GT(box.length.variance_m2, 1.0);  // which of the two is open
}

TEST(Box, IsNotBelievedToBeAPieceThatNothingOnTheRoadIsLike) {
  Box box;
  box.is_oriented = true;
  box.evidence.width = {2.4, {2.5, 0.01}};
  box.evidence.length = {1.8, {2.0, 0.01}};  // as wide as a bus and as long as a bicycle
  box = with_likely_sizes(box, kConfig);
  EXPECT_TRUE(box.kind == Kind::kTruck || box.kind == Kind::kBus);
  EXPECT_GT(box.length.value_m, 5.0);
  EXPECT_GT(box.length.variance_m2, 1.0);
}

TEST(Box, TurnedAboutIsHeldAtTheEndAtWhichItWas) {
  Box box = car_of_unknown_length();
  box.anchors.length = 1;
  const Box turned = turned_about(box);
  EXPECT_NEAR(std::cos(turned.heading_rad - box.heading_rad), -1.0, 1e-9);
  EXPECT_EQ(turned.anchors.length, -1);
  EXPECT_FALSE(turned.anchors.width.has_value());
}

TEST(Box, OfWhichMoreWasSeenThanWasTakenForTheWholeWasSeenInPieces) {
  Box box;
  box.is_oriented = true;
  box.evidence.width = {2.4, {2.45, 0.01}};
  box.evidence.length = {8.8, {6.6, 0.04}};  // a bus, the rear of which something hid
  box = with_likely_sizes(box, kConfig);
  EXPECT_EQ(box.kind, Kind::kBus);
  EXPECT_GT(box.length.value_m, 11.0);
  EXPECT_GT(std::sqrt(box.length.variance_m2), 1.0)
      << "nothing tells how long it is but what buses are";
}

TEST(Box, KnowsTheLengthAsItsWidthAfterAQuarterTurn) {
  Box box;
  box.evidence.length.least_m = 1.9;
  box = with_likely_sizes(box, kConfig);
  const Box turned = turned_by_a_quarter(box, 1.0, kConfig);
  EXPECT_NEAR(std::abs(std::sin(turned.heading_rad)), 1.0, 1e-9);
  EXPECT_GE(turned.width.value_m, 1.9);
  EXPECT_GT(turned.length.value_m, turned.width.value_m);
}

TEST(Box, ScalesWithTheRoadUsersOfALaboratory) {
  TrackingConfig model_cars;
  model_cars.extent.size_scale = 0.1;
  Box box;
  EXPECT_NEAR(with_likely_sizes(box, model_cars).length.value_m,
              0.1 * with_likely_sizes(box, kConfig).length.value_m, 1e-5);
}

TEST(Box, OfTwoThingsThatAreNoneOnTheRoadIsNotPlausible) {
  Box box;
  EXPECT_TRUE(is_plausible(box, kConfig));
  box.evidence.width.least_m = 4.0;
  EXPECT_FALSE(is_plausible(box, kConfig));
}

}  // namespace
}  // namespace slammot::tracking
