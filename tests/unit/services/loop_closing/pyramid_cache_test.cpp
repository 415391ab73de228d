#include "services/loop_closing/pyramid_cache.hpp"

#include <gtest/gtest.h>

namespace slammot::loop_closing {
namespace {

using geometry::Pose2;

/// Two submaps with a wall each, the second so far ahead of the first.
struct TwoPlaces {
  explicit TwoPlaces(double ahead_m) : target{{{&first, {}}, {&second, {ahead_m, 0.0, 0.0}}}} {}

  static Place place(std::uint32_t id) {
    Place place;
    place.id = flow::SubmapId{id};
    for (int i = 0; i < 20; ++i) {
      flow::Surfel surfel;
      surfel.x_m = 0.1F * static_cast<float>(i);
      surfel.y_m = 1.0F;
      place.surfels.push_back(surfel);
    }
    return place;
  }

  Place first = place(1);
  Place second = place(2);
  Target target;
};

TEST(PyramidCache, MakesThePyramidOfOneTargetOnce) {
  PyramidCache cache;
  const TwoPlaces places(5.0);
  const auto made = cache.pyramid_of(places.target, 0.1);
  EXPECT_GT(made.work, 0U);
  const auto kept = cache.pyramid_of(places.target, 0.1);
  EXPECT_EQ(kept.pyramid, made.pyramid);
  EXPECT_EQ(kept.work, 0U);
  EXPECT_NE(cache.pyramid_of(places.target, 0.2).pyramid, made.pyramid) << "of other cells";
}

TEST(PyramidCache, KeepsItWhileMembersMoveByLessThanAQuarterOfACell) {
  PyramidCache cache;
  const auto made = cache.pyramid_of(TwoPlaces(5.0).target, 0.1);
  EXPECT_EQ(cache.pyramid_of(TwoPlaces(5.02).target, 0.1).pyramid, made.pyramid);
  EXPECT_NE(cache.pyramid_of(TwoPlaces(5.03).target, 0.1).pyramid, made.pyramid);
}

TEST(PyramidCache, ForgetsTheOneThatWasUsedLongestAgo) {
  PyramidCache cache;
  const auto first = cache.pyramid_of(TwoPlaces(0.0).target, 0.1);
  const auto second = cache.pyramid_of(TwoPlaces(1.0).target, 0.1);
  for (int i = 2; i < 64; ++i) cache.pyramid_of(TwoPlaces(i).target, 0.1);
  EXPECT_EQ(cache.pyramid_of(TwoPlaces(0.0).target, 0.1).pyramid, first.pyramid);
  cache.pyramid_of(TwoPlaces(64.0).target, 0.1);
  EXPECT_EQ(cache.pyramid_of(TwoPlaces(0.0).target, 0.1).pyramid, first.pyramid);
  EXPECT_NE(cache.pyramid_of(TwoPlaces(1.0).target, 0.1).pyramid, second.pyramid);
}

}  // namespace
}  // namespace slammot::loop_closing
