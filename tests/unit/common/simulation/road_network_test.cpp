#include "common/simulation/road_network.hpp"

#include <algorithm>

#include <gtest/gtest.h>

#include "tests/support/matchers.hpp"

namespace slammot::simulation {
namespace {

using slammot::testing::PoseNear;

class RoadNetworkOfACity : public ::testing::Test {
 protected:
  StreetPlan plan_{CityConfig{}, 3};
  RoadNetwork network_{plan_};
};

TEST_F(RoadNetworkOfACity, JoinsLanesEndToStart) {
  ASSERT_FALSE(network_.lanes().empty());
  for (const Lane& lane : network_.lanes()) {
    ASSERT_FALSE(lane.next.empty());
    for (const int next : lane.next) {
      const geometry::Pose2 end = lane.path_in_world.pose_at(lane.path_in_world.length_m());
      EXPECT_THAT(network_.lane(next).path_in_world.pose_at(0.0), PoseNear(end, 0.05));
    }
  }
}

TEST_F(RoadNetworkOfACity, LetsOppositeStraightTrafficPassButNotCrossingTraffic) {
  const int junction = plan_.index({1, 1});
  const auto straight_from = [&](Direction travel) {
    for (std::size_t i = 0; i < network_.lanes().size(); ++i) {
      const Lane& lane = network_.lanes()[i];
      if (lane.kind == LaneKind::turn && lane.junction == junction &&
          lane.turn == TurnKind::straight && lane.user == RoadUser::motor &&
          lane.travel == travel) {
        return static_cast<int>(i);
      }
    }
    return -1;
  };
  const auto& conflicts = network_.lane(straight_from(Direction::east)).conflicts;
  EXPECT_EQ(std::count(conflicts.begin(), conflicts.end(), straight_from(Direction::west)), 0);
  EXPECT_EQ(std::count(conflicts.begin(), conflicts.end(), straight_from(Direction::north)), 1);
  EXPECT_EQ(std::count(conflicts.begin(), conflicts.end(), straight_from(Direction::south)), 1);
}

TEST_F(RoadNetworkOfACity, KeepsRight) {
  const geometry::Vector2 centre = plan_.world_from_plan(plan_.junction_in_plan({1, 1}));
  const int lane = network_.street_lane(RoadUser::motor, plan_.index({1, 1}), Direction::east);
  EXPECT_LT(network_.lane(lane).path_in_world.pose_at(0.0).y_m, centre.y() + 1.0);
}

TEST_F(RoadNetworkOfACity, HasNoStreetOutOfTheCity) {
  EXPECT_EQ(network_.street_lane(RoadUser::motor, plan_.index({0, 0}), Direction::west), -1);
}

}  // namespace
}  // namespace slammot::simulation
