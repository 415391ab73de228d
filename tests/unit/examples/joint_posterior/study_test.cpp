#include "examples/joint_posterior/study.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "examples/joint_posterior/joint_filter.hpp"
#include "examples/joint_posterior/report.hpp"

namespace slammot::joint_posterior {
namespace {

constexpr Crowd kCrowd{12, 4};
constexpr int kSeeds = 4;
const Clock kNoClock = [] { return 0.0; };

TEST(JointPosterior, DecompositionCostsLittleAndSavesMuch) {
  const Score joint = score_of(Method::kJoint, kCrowd, kSeeds, kNoClock);
  const Score decomposed = score_of(Method::kDecomposed, kCrowd, kSeeds, kNoClock);
  EXPECT_LT(decomposed.pose_rmse_m, 1.2 * joint.pose_rmse_m);
  EXPECT_LT(decomposed.mover_rmse_m, 1.2 * joint.mover_rmse_m);
  EXPECT_LT(decomposed.numbers, 0.5 * joint.numbers);
}

TEST(JointPosterior, IsConsistentInPoseAndMovers) {
  const Score joint = score_of(Method::kJoint, kCrowd, kSeeds, kNoClock);
  EXPECT_GT(joint.pose_nees, 0.5);
  EXPECT_LT(joint.pose_nees, 1.6);
  EXPECT_GT(joint.mover_nees, 0.5);
  EXPECT_LT(joint.mover_nees, 1.6);
}

TEST(JointPosterior, NeedsNotToldWhichObjectsAreLandmarksButIsLessAccurateThen) {
  const Score generic = score_of(Method::kGeneric, kCrowd, kSeeds, kNoClock);
  const Score joint = score_of(Method::kJoint, kCrowd, kSeeds, kNoClock);
  EXPECT_LT(generic.pose_rmse_m, 2.0 * joint.pose_rmse_m);
  EXPECT_GT(generic.pose_rmse_m, joint.pose_rmse_m);
}

TEST(JointPosterior, MoversAreOverconfidentWithoutThePosesCovariance) {
  const Score decomposed = score_of(Method::kDecomposed, kCrowd, kSeeds, kNoClock);
  const Score taken_as_true = score_of(Method::kPoseTakenAsTrue, kCrowd, kSeeds, kNoClock);
  EXPECT_GT(taken_as_true.mover_nees, 1.5 * decomposed.mover_nees);
}

TEST(JointPosterior, AStandingObjectMakesThePoseCertain) {
  JointFilter filter;
  const std::size_t object = filter.add(ObjectKind::kGeneric, {10.0, 0.5});
  for (int period = 0; period < 20; ++period) {
    filter.predict({});
    filter.update(object, {10.0, 0.5});
  }
  EXPECT_LT(filter.estimate(object).mean.tail<2>().norm(), 0.05) << "its velocity";
  JointFilter alone;
  for (int period = 0; period < 20; ++period) alone.predict({});
  EXPECT_LT(filter.pose_covariance().trace(), 0.5 * alone.pose_covariance().trace());
}

TEST(Table, GoesBetweenTheMarkersOnly) {
  const std::string page =
      "before\n<!-- joint_posterior: begin -->\nold\n<!-- joint_posterior: end -->\nafter\n";
  EXPECT_EQ(with_table(page, "new\n"),
            "before\n<!-- joint_posterior: begin -->\nnew\n<!-- joint_posterior: end -->\nafter\n");
  EXPECT_TRUE(with_table("no markers", "new\n").empty());
}

}  // namespace
}  // namespace slammot::joint_posterior
