#include "services/tracking/associations.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace slammot::tracking {
namespace {

using association::kUnassigned;
using flow::PointLabel;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

/// Two tracks with a segment each, and a segment of nobody's.
Associations two_tracks() {
  Associations associations;
  associations.shares.resize(2);
  associations.shares[0].beams = {1, 2, 3};
  associations.shares[1].beams = {6, 7};
  associations.track_of_segment = {0, 1, kUnassigned};
  return associations;
}

TEST(Associations, ReleasedLeaveTheSegmentsToOthers) {
  Associations associations = two_tracks();
  release(associations, 0);
  EXPECT_FALSE(associations.has_echoes(0));
  EXPECT_TRUE(associations.is_unassigned(0));
  EXPECT_FALSE(associations.is_unassigned(1));
  EXPECT_THAT(associations.shares[1].beams, ElementsAre(6, 7));
}

TEST(Associations, MovedAreInTheOrderOfTheBeams) {
  Associations associations = two_tracks();
  move_beams(associations, 0, 1);
  EXPECT_THAT(associations.shares[0].beams, IsEmpty());
  EXPECT_THAT(associations.shares[1].beams, ElementsAre(1, 2, 3, 6, 7));
}

TEST(Associations, ClearedAssignNothing) {
  Associations associations = two_tracks();
  associations.shares[0].label = PointLabel::kMoving;
  clear(associations, 5);
  EXPECT_THAT(associations.track_of_segment,
              ElementsAre(kUnassigned, kUnassigned, kUnassigned, kUnassigned, kUnassigned));
  EXPECT_FALSE(associations.has_echoes(0));
  EXPECT_EQ(associations.shares[0].label, PointLabel::kUnknown);
}

TEST(Associations, LetMovingPrevailOverStationaryAndThatOverUnknown) {
  EXPECT_EQ(stronger(PointLabel::kMoving, PointLabel::kStationary), PointLabel::kMoving);
  EXPECT_EQ(stronger(PointLabel::kUnknown, PointLabel::kStationary), PointLabel::kStationary);
  EXPECT_EQ(stronger(PointLabel::kUnknown, PointLabel::kUnknown), PointLabel::kUnknown);
}

}  // namespace
}  // namespace slammot::tracking
