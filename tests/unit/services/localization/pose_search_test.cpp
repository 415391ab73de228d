#include "services/localization/pose_search.hpp"

#include <gtest/gtest.h>

#include "tests/support/mapped_world.hpp"
#include "tests/support/matchers.hpp"

namespace slammot::localization {
namespace {

using geometry::Pose2;
using geometry::UncertainPose2;
using slammot::testing::MappedWorld;
using slammot::testing::PoseNear;

UncertainPose2 prior_at(const Pose2& pose, double sigma_m, double sigma_rad) {
  return {
      pose,
      Eigen::Vector3d(sigma_m * sigma_m, sigma_m * sigma_m, sigma_rad * sigma_rad).asDiagonal()};
}

TEST(IsVague, WherePositionOrHeadingIsUnsure) {
  const LocalizerConfig config;
  EXPECT_FALSE(is_vague(
      prior_at({}, 0.9 * config.search.when_sigma_m, 0.9 * config.search.when_heading_sigma_rad),
      config));
  EXPECT_TRUE(is_vague(prior_at({}, 1.1 * config.search.when_sigma_m, 0.0), config));
  EXPECT_TRUE(is_vague(prior_at({}, 0.0, 1.1 * config.search.when_heading_sigma_rad), config));
}

TEST(PoseSearch, FindsThePoseWithinItsWindow) {
  const MappedWorld room(slammot::testing::room());
  const Pose2 truth{0.5, -0.4, 0.2};
  PoseSearch search(room.config(), 1);
  const auto poses = search.poses_around(prior_at({0.0, 0.0, 0.0}, 0.5, 0.15),
                                         room.points_at(truth).matched(), room.map().surfels());
  ASSERT_FALSE(poses.empty());
  EXPECT_THAT(poses.front(), PoseNear(truth, 0.15));
}

TEST(PoseSearch, LooksNoFartherThanThePriorAllows) {
  const MappedWorld room(slammot::testing::room());
  PoseSearch search(room.config(), 1);
  const auto points = room.points_at({2.0, 0.0, 0.0}).matched();
  const auto found =
      search.poses_around(prior_at({0.0, 0.0, 0.0}, 1.0, 0.01), points, room.map().surfels());
  ASSERT_FALSE(found.empty());
  EXPECT_THAT(found.front(), PoseNear(Pose2{2.0, 0.0, 0.0}, 0.15));
  const auto poses =
      search.poses_around(prior_at({0.0, 0.0, 0.0}, 0.1, 0.01), points, room.map().surfels());
  for (const auto& pose : poses)
    EXPECT_LT(pose.translation_m().norm(),
              0.1 * room.config().search.sigmas * std::sqrt(2.0) + 0.3);
}

TEST(PoseSearch, TakesLargerCellsOnlyInLargeWindows) {
  const LocalizerConfig config;
  const PoseSearch search(config, 1);
  EXPECT_FALSE(search.is_coarse_in({1.0, 1.0, 0.3}));
  EXPECT_TRUE(search.is_coarse_in({30.0, 30.0, 3.1}));
}

}  // namespace
}  // namespace slammot::localization
