#include "common/metrics/identity.hpp"

#include <gtest/gtest.h>

#include "tests/unit/common/metrics/sequence.hpp"

namespace slammot::metrics {
namespace {

TEST(Identity, OfAnObjectFollowedByTwoTracksCountsTheLongerOneOnly) {
  const auto first = scan({{0, 0.0}}, {{0, 0.0}});
  const auto second = scan({{0, 0.0}}, {{1, 0.0}});
  const Identity result = identity({1, 2, {first, second, second}}, 0.5);
  EXPECT_EQ(result.true_positives, 2U);
  EXPECT_EQ(result.false_negatives, 1U);
  EXPECT_EQ(result.false_positives, 1U);
  EXPECT_DOUBLE_EQ(result.f1, 2.0 * 2.0 / 6.0);
}

TEST(Identity, GivesEachTrackOneObject) {
  // Track 0 follows object 0 in two scans and object 1 in three; object 0 is otherwise followed by
  // nobody.
  const auto on_first = scan({{0, 0.0}, {1, 9.0}}, {{0, 0.0}});
  const auto on_second = scan({{0, 0.0}, {1, 9.0}}, {{0, 9.0}});
  EXPECT_EQ(
      identity({2, 1, {on_first, on_first, on_second, on_second, on_second}}, 0.5).true_positives,
      3U);
}

TEST(Identity, OfNothingIsZero) { EXPECT_EQ(identity({}, 0.5).f1, 0.0); }

}  // namespace
}  // namespace slammot::metrics
