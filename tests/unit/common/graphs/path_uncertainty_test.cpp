#include "common/graphs/path_uncertainty.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "tests/support/matchers.hpp"

namespace slammot::graphs {
namespace {

using flow::Constraint;
using flow::ConstraintKind;
using flow::SubmapId;
using geometry::Pose2;
using slammot::testing::PoseNear;

Constraint step_forward(std::uint32_t from, std::uint32_t to, double length_m, double sigma_m) {
  Constraint constraint{
      SubmapId{from}, SubmapId{to}, ConstraintKind::kOdometric, {{length_m, 0.0, 0.0}, {}}};
  constraint.from_to.covariance =
      Eigen::Vector3d(sigma_m * sigma_m, sigma_m * sigma_m, 1e-6).asDiagonal();
  return constraint;
}

TEST(PosesAlongBestPaths, GrowsMoreUncertainWithEveryStep) {
  const std::vector<Constraint> chain{step_forward(0, 1, 5.0, 0.1), step_forward(1, 2, 5.0, 0.1),
                                      step_forward(2, 3, 5.0, 0.1)};
  const auto poses = poses_along_best_paths(SubmapId{0}, chain);
  ASSERT_EQ(poses.size(), 4U);
  EXPECT_THAT(poses.at(SubmapId{3}).pose, PoseNear(Pose2{15.0, 0.0, 0.0}, 1e-12));
  EXPECT_NEAR(std::sqrt(poses.at(SubmapId{3}).covariance(0, 0)), 0.1 * std::sqrt(3.0), 1e-6);
}

TEST(PosesAlongBestPaths, WalksBackwardsAlongAConstraint) {
  const std::vector<Constraint> chain{step_forward(0, 1, 5.0, 0.1), step_forward(1, 2, 5.0, 0.1)};
  EXPECT_THAT(poses_along_best_paths(SubmapId{2}, chain).at(SubmapId{0}).pose,
              PoseNear(Pose2{-10.0, 0.0, 0.0}, 1e-12));
}

TEST(PosesAlongBestPaths, TakesTheShortcutThatALoopGives) {
  std::vector<Constraint> chain;
  for (std::uint32_t i = 0; i < 10; ++i) chain.push_back(step_forward(i, i + 1, 1.0, 0.3));
  chain.push_back(step_forward(0, 10, 0.2, 0.05));
  const auto poses = poses_along_best_paths(SubmapId{0}, chain);
  EXPECT_THAT(poses.at(SubmapId{10}).pose, PoseNear(Pose2{0.2, 0.0, 0.0}, 1e-12));
  EXPECT_NEAR(std::sqrt(poses.at(SubmapId{10}).covariance(1, 1)), 0.05, 1e-9);
  EXPECT_THAT(poses.at(SubmapId{9}).pose, PoseNear(Pose2{-0.8, 0.0, 0.0}, 1e-12));
}

TEST(PosesAlongBestPaths, LeavesOutWhatNoPathReaches) {
  const auto poses =
      poses_along_best_paths(SubmapId{0}, std::vector<Constraint>{step_forward(1, 2, 1.0, 0.1)});
  ASSERT_EQ(poses.size(), 1U);
  EXPECT_THAT(poses.at(SubmapId{0}).pose, PoseNear(Pose2::identity(), 0.0));
}

}  // namespace
}  // namespace slammot::graphs
