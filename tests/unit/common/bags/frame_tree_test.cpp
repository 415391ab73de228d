#include "common/bags/frame_tree.hpp"

#include <numbers>

#include <gtest/gtest.h>

namespace slammot::bags {
namespace {

TransformMessage transform(const std::string& parent, const std::string& child, double x_m,
                           double heading_rad = 0.0) {
  return {{0, parent},
          child,
          {Eigen::Vector3d(x_m, 0.0, 0.0),
           Eigen::Quaterniond(Eigen::AngleAxisd(heading_rad, Eigen::Vector3d::UnitZ()))}};
}

TEST(FrameTree, ChainsFramesThatAreFixedToEachOther) {
  FrameTree tree;
  tree.add(transform("base_link", "mast", 1.0, std::numbers::pi / 2.0), 0);
  tree.add(transform("mast", "laser", 0.5), 0);
  const auto base_from_laser = tree.fixed("base_link", "laser");
  ASSERT_TRUE(base_from_laser);
  EXPECT_LT((base_from_laser->translation_m - Eigen::Vector3d(1.0, 0.5, 0.0)).norm(), 1e-12);
}

TEST(FrameTree, GoesUpAndDownAgain) {
  FrameTree tree;
  tree.add(transform("base_footprint", "base_link", 0.2), 0);
  tree.add(transform("base_footprint", "laser", 1.0), 0);
  EXPECT_NEAR(tree.fixed("base_link", "laser")->translation_m.x(), 0.8, 1e-12);
}

TEST(FrameTree, KeepsAMovingFrameApart) {
  FrameTree tree;
  tree.add(transform("odom", "base_link", 0.0), 1);
  tree.add(transform("odom", "base_link", 0.1), 2);
  tree.add(transform("base_link", "laser", 0.3), 0);
  EXPECT_FALSE(tree.fixed("odom", "laser"));
  ASSERT_NE(tree.first_moving_above("laser"), nullptr);
  EXPECT_EQ(tree.first_moving_above("laser")->parent, "odom");
  EXPECT_EQ(tree.first_moving_above("laser")->poses.size(), 2U);
  EXPECT_EQ(tree.fixed_root("laser"), "base_link");
}

TEST(FrameTree, KeepsAFewPosesOfWhatIsSaidAgainAndAgain) {
  FrameTree tree;
  for (int i = 0; i < 10'000; ++i) tree.add(transform("base_link", "laser", 0.3), i);
  EXPECT_LT(tree.edge_above("laser")->poses.size(), 5000U);
  EXPECT_EQ(tree.edge_above("laser")->poses.back().log_time_ns, 9999);
  EXPECT_TRUE(tree.fixed("base_link", "laser"));
}

TEST(FrameTree, EndsWhereFramesGoInACircle) {
  FrameTree tree;
  tree.add(transform("a", "b", 1.0), 0);
  tree.add(transform("b", "a", 1.0), 0);
  EXPECT_EQ(tree.fixed_root("a"), "a");
  EXPECT_FALSE(tree.fixed("c", "a"));
}

}  // namespace
}  // namespace slammot::bags
