#include "services/tracking/projection.hpp"

#include <vector>

#include <gtest/gtest.h>

namespace slammot::tracking {
namespace {

using Eigen::Vector2d;

/// The rear and the left flank of a car at heading 0, seen from the origin.
const std::vector<Vector2d> kCorner = {{14.0, 3.0}, {13.0, 3.0}, {12.0, 3.0}, {11.0, 3.0},
                                       {10.0, 3.0}, {10.0, 3.5}, {10.0, 4.0}, {10.0, 4.5}};

Observation corner() {
  Observation observation;
  observation.points_m = kCorner;
  observation.start = Edge::kOpen;
  observation.end = Edge::kHidden;
  return observation;
}

TEST(Projection, HasTheEndsOfItsPoints) {
  const Projection along = span_of(corner(), {12.0, 4.0}, Vector2d::UnitX());
  EXPECT_EQ(along.low_m, -2.0);
  EXPECT_EQ(along.high_m, 2.0);
  EXPECT_EQ(along.count, 8);
}

TEST(Projection, EndsAtAnEdgeOfTheObservationOnlyWithItsFirstOrLastPoint) {
  const Projection across = span_of(corner(), {12.0, 4.0}, Vector2d::UnitY());
  EXPECT_EQ(across.high_edge, Edge::kHidden);
  EXPECT_EQ(span_of(corner(), {12.0, 4.0}, Vector2d::UnitX()).high_edge, Edge::kOpen);
}

TEST(Projection, HasTheFaceTowardsTheLaser) {
  const Projection along = projection_of(corner(), {12.0, 4.0}, Vector2d::UnitX(), 0.2);
  EXPECT_NEAR(along.face_m, -2.0, 1e-12);
  EXPECT_NEAR(along.face_across_m, 1.5, 1e-12);
  EXPECT_EQ(along.face_count, 4);
}

TEST(Projection, MirroredIsThatOnTheOppositeAxis) {
  const Projection along = projection_of(corner(), {12.0, 4.0}, Vector2d::UnitX(), 0.2);
  const Projection against = projection_of(corner(), {12.0, 4.0}, -Vector2d::UnitX(), 0.2);
  const Projection mirrored_along = mirrored(along);
  EXPECT_EQ(mirrored_along.low_m, against.low_m);
  EXPECT_EQ(mirrored_along.high_m, against.high_m);
  EXPECT_EQ(mirrored_along.low_edge, against.low_edge);
  EXPECT_EQ(mirrored_along.high_edge, against.high_edge);
  EXPECT_NEAR(mirrored_along.face_m, against.face_m, 1e-12);
  EXPECT_EQ(mirrored_along.face_count, against.face_count);
}

}  // namespace
}  // namespace slammot::tracking
