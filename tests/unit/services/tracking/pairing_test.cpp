#include "services/tracking/pairing.hpp"

#include <gtest/gtest.h>

#include "common/association/assignment.hpp"

namespace slammot::tracking {
namespace {

TrackingConfig where_only_people_move() {
  TrackingConfig config;
  config.longest_body_m = 2.0;
  return config;
}

/// Somebody who walks, where the segment's middle is.
double cost_for_a_walker(double length_m, flow::PointLabel label, const TrackingConfig& config) {
  Body body;
  body.length = body.width = {0.4, 1.0};
  filters::MotionState motion;
  motion.covariance = 0.04 * filters::Matrix6::Identity();
  flow::Segment segment;
  segment.label = label;
  segment.box_length_m = length_m;
  segment.centroid_covariance_m2 = 0.01 * Eigen::Matrix2d::Identity();
  return pair_cost(body, motion, segment, config);
}

TEST(PairCost, DoesNotGiveFurnitureToWhoWalksWhereOnlyPeopleMove) {
  EXPECT_EQ(cost_for_a_walker(1.1, flow::PointLabel::kStationary, where_only_people_move()), association::kForbidden);
  EXPECT_EQ(cost_for_a_walker(1.1, flow::PointLabel::kUnknown, where_only_people_move()), association::kForbidden);
  EXPECT_LT(cost_for_a_walker(0.3, flow::PointLabel::kStationary, where_only_people_move()), kCostOfLeavingOut);
}

TEST(PairCost, GivesThemWhatMovesHoweverWideItIs) {
  EXPECT_LT(cost_for_a_walker(1.1, flow::PointLabel::kMoving, where_only_people_move()), kCostOfLeavingOut);
}

TEST(PairCost, DoesNotKnowFurnitureOnARoad) { EXPECT_LT(cost_for_a_walker(1.1, flow::PointLabel::kUnknown, {}), kCostOfLeavingOut); }

}  // namespace
}  // namespace slammot::tracking
