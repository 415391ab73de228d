#include "common/dds/qos.hpp"

#include <gtest/gtest.h>

namespace slammot::dds {
namespace {

TEST(QosProfile, KeepsForLateJoinersWhatIsAState) {
  for (const Flow flow : {Flow::kTile, Flow::kGraph, Flow::kStatus}) {
    EXPECT_EQ(qos_profile(flow).durability, Durability::kTransientLocal);
  }
  for (const Flow flow : {Flow::kSensor, Flow::kEstimate, Flow::kHeartbeat, Flow::kCommand}) {
    EXPECT_EQ(qos_profile(flow).durability, Durability::kVolatile);
  }
}

TEST(QosProfile, KeepsForRestartsWhatAScanPasses) {
  for (const Flow flow : {Flow::kSensor, Flow::kEstimate})
    EXPECT_GE(qos_profile(flow).restart_depth, 100);
  for (const Flow flow : {Flow::kStatus, Flow::kHeartbeat, Flow::kCommand})
    EXPECT_EQ(qos_profile(flow).restart_depth, 0);
}

TEST(QosProfile, LetsWritersRepairALossyLink) {
  for (const Flow flow : {Flow::kSensor, Flow::kEstimate, Flow::kCommand})
    EXPECT_GE(qos_profile(flow).writer_depth, 8);
}

TEST(QosProfile, KeepsEstimatesFresh) { EXPECT_LE(qos_profile(Flow::kEstimate).reader_depth, 4); }

TEST(QosPolicyName, FollowsTheNumbersOfTheReports) {
  EXPECT_EQ(qos_policy_name(2), "durability");
  EXPECT_EQ(qos_policy_name(4), "deadline");
  EXPECT_EQ(qos_policy_name(6), "ownership");
  EXPECT_EQ(qos_policy_name(8), "liveliness");
  EXPECT_EQ(qos_policy_name(10), "partition");
  EXPECT_EQ(qos_policy_name(11), "reliability");
  EXPECT_EQ(qos_policy_name(24), "type");
  EXPECT_EQ(qos_policy_name(99), "policy 99");
}

}  // namespace
}  // namespace slammot::dds
