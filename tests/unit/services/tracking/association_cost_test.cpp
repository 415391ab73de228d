#include "services/tracking/association_cost.hpp"

#include <gtest/gtest.h>

#include "common/association/assignment.hpp"

namespace slammot::tracking {
namespace {

TrackingConfig where_only_people_move() {
  TrackingConfig config;
  config.extent.longest_body_m = 2.0;
  return config;
}

/// Somebody who walks, where the segment's middle is.
double cost_for_a_walker(double length_m, flow::PointLabel label, const TrackingConfig& config) {
  Blob blob;
  blob.length = blob.width = {0.4, 1.0};
  filters::MotionState motion;
  motion.covariance = 0.04 * filters::Matrix6::Identity();
  flow::Segment segment;
  segment.label = label;
  segment.box_length_m = length_m;
  segment.centroid_covariance_m2 = 0.01 * Eigen::Matrix2d::Identity();
  return association_cost(blob, motion, segment, config);
}

TEST(AssociationCost, DoesNotGiveFurnitureToWhoWalksWhereOnlyPeopleMove) {
  EXPECT_EQ(cost_for_a_walker(1.1, flow::PointLabel::kStationary, where_only_people_move()),
            association::kForbidden);
  EXPECT_EQ(cost_for_a_walker(1.1, flow::PointLabel::kUnknown, where_only_people_move()),
            association::kForbidden);
  EXPECT_LT(cost_for_a_walker(0.3, flow::PointLabel::kStationary, where_only_people_move()),
            kCostOfMiss);
}

TEST(AssociationCost, GivesThemWhatMovesHoweverWideItIs) {
  EXPECT_LT(cost_for_a_walker(1.1, flow::PointLabel::kMoving, where_only_people_move()),
            kCostOfMiss);
}

TEST(AssociationCost, DoesNotKnowFurnitureOnARoad) {
  EXPECT_LT(cost_for_a_walker(1.1, flow::PointLabel::kUnknown, {}), kCostOfMiss);
}

TEST(AssociationCost, IsLessForTheNearerSegmentAndForbiddenForABackdrop) {
  const TrackingConfig config;
  Blob blob;
  blob.length = blob.width = {0.5, 0.1};
  filters::MotionState motion;
  motion.covariance = 0.04 * filters::Matrix6::Identity();
  const auto segment_at = [](double x_m) {
    flow::Segment segment;
    segment.label = flow::PointLabel::kMoving;
    segment.centroid_in_odom_m = {x_m, 0.0};
    segment.box_length_m = 0.4;
    return segment;
  };
  EXPECT_LT(association_cost(blob, motion, segment_at(0.1), config),
            association_cost(blob, motion, segment_at(0.5), config));
  EXPECT_EQ(association_cost(blob, motion, segment_at(3.0), config), association::kForbidden);
  flow::Segment wall = segment_at(0.1);
  wall.label = flow::PointLabel::kStationary;
  wall.box_length_m = 2.0 * config.extent.longest_body_m;
  EXPECT_EQ(association_cost(blob, motion, wall, config), association::kForbidden);
}

}  // namespace
}  // namespace slammot::tracking
