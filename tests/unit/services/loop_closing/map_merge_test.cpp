#include "services/loop_closing/map_merge.hpp"

#include <algorithm>

#include <gtest/gtest.h>

#include "services/loop_closing/loop_closer.hpp"
#include "tests/support/matchers.hpp"
#include "tests/support/ring_drive.hpp"

namespace slammot::loop_closing {
namespace {

using flow::Submap;
using geometry::Pose2;
using slammot::testing::drive;
using slammot::testing::FloorPlan;
using slammot::testing::indoor_loop_closing;
using slammot::testing::PoseNear;
using slammot::testing::ring;
using slammot::testing::way_around_the_ring;

/// Part of a round about the ring: 168 poses, twelve a submap.
std::vector<Pose2> way(std::size_t first, std::size_t last) {
  const auto round = way_around_the_ring(2.0);
  return {round.begin() + static_cast<std::ptrdiff_t>(first),
          round.begin() + static_cast<std::ptrdiff_t>(last)};
}

class MapMerge : public ::testing::Test {
 protected:
  MapMerge() : first_way_(way(0, 109)), second_way_(way(40, 137)) {}

  Merge merged() const {
    return merge_maps(indoor_loop_closing(), drive(ring(), first_way_, 0.0),
                      drive(ring(), second_way_, 0.0));
  }

  /// True pose of a submap in the frame of the first map.
  Pose2 truth(std::size_t submap) const {
    const std::size_t of_first = 9;
    return inverse(first_way_.front()) *
           (submap < of_first ? first_way_[12 * submap] : second_way_[12 * (submap - of_first)]);
  }

  std::vector<Pose2> first_way_;
  std::vector<Pose2> second_way_;
};

TEST_F(MapMerge, JoinsTwoDrivesThroughOnePlace) {
  const Merge merge = merged();
  ASSERT_EQ(merge.outcome, MergeOutcome::kJoined);
  EXPECT_GE(merge.places, 3);
  EXPECT_EQ(merge.contradicting, 0);
  ASSERT_EQ(merge.submaps.size(), 17U);
  ASSERT_EQ(merge.correction.submaps.size(), 17U);
  for (std::size_t i = 0; i < merge.submaps.size(); ++i) {
    EXPECT_EQ(merge.submaps[i].submap_id.value, i);
    EXPECT_THAT(merge.correction.submaps[i].map_from_submap, PoseNear(truth(i), 0.15));
  }
}

TEST_F(MapMerge, DoesNotDependOnTheFrameOrTheNumbersOfTheSecondMap) {
  std::vector<Submap> second = drive(ring(), second_way_, 0.0);
  for (Submap& submap : second) {
    submap.submap_id.value += 40;
    submap.odom_from_submap = Pose2{-700.0, 90.0, 2.0} * submap.odom_from_submap;
  }
  const Merge moved = merge_maps(indoor_loop_closing(), drive(ring(), first_way_, 0.0), second);
  const Merge merge = merged();
  ASSERT_EQ(moved.outcome, MergeOutcome::kJoined);
  for (std::size_t i = 0; i < merge.submaps.size(); ++i)
    EXPECT_THAT(moved.correction.submaps[i].map_from_submap,
                PoseNear(merge.correction.submaps[i].map_from_submap, 1e-6));
}

TEST_F(MapMerge, LeavesSubmapsFromWhichTheSameGraphIsBuiltWithoutASearch) {
  const Merge merge = merged();
  LoopCloser closer(indoor_loop_closing());
  flow::GraphCorrection correction;
  for (const Submap& submap : merge.submaps) {
    correction = closer.add(submap);
    EXPECT_FALSE(correction.is_untied);
  }
  EXPECT_EQ(closer.counters().found_elsewhere, 0U);
  for (std::size_t i = 0; i < merge.submaps.size(); ++i)
    EXPECT_THAT(correction.submaps[i].map_from_submap, PoseNear(truth(i), 0.2));
}

TEST_F(MapMerge, RefusesDrivesThroughDifferentPlaces) {
  FloorPlan elsewhere;  // corridors of the same width without any feature of the ring
  elsewhere.add_box({0, 0}, {20, 20});
  elsewhere.add_box({-2.3, -2.2}, {22.4, 22.1});
  for (double at_m = -1.0; at_m < 20.0; at_m += 4.3) {
    elsewhere.add_box({at_m, -0.5}, {at_m + 0.4, -0.1});
    elsewhere.add_box({21.9, at_m}, {22.3, at_m + 0.8});
    elsewhere.add_box({at_m, 20.1}, {at_m + 0.2, 20.4});
  }
  const Merge merge = merge_maps(indoor_loop_closing(), drive(ring(), first_way_, 0.0),
                                 drive(elsewhere, second_way_, 0.0));
  EXPECT_NE(merge.outcome, MergeOutcome::kJoined);
}

TEST_F(MapMerge, RefusesDrivesThatShareTooFewSubmaps) {
  const Merge merge = merge_maps(indoor_loop_closing(), drive(ring(), way(0, 61), 0.0),
                                 drive(ring(), way(30, 55), 0.0));
  EXPECT_NE(merge.outcome, MergeOutcome::kJoined);
  EXPECT_EQ(merge.submaps.size(), 7U);
}

}  // namespace
}  // namespace slammot::loop_closing
