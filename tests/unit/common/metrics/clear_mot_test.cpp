#include "common/metrics/clear_mot.hpp"

#include <gtest/gtest.h>

#include "tests/unit/common/metrics/sequence.hpp"

namespace slammot::metrics {
namespace {

TEST(ClearMot, OfPerfectTracksIsOne) {
  const ClearMot clear = clear_mot({2,
                                    2,
                                    {scan({{0, 0.0}, {1, 5.0}}, {{1, 0.0}, {0, 5.0}}),
                                     scan({{0, 0.1}, {1, 5.1}}, {{1, 0.1}, {0, 5.1}})}},
                                   0.5);
  EXPECT_EQ(clear.true_positives, 4U);
  EXPECT_DOUBLE_EQ(clear.mota, 1.0);
  EXPECT_DOUBLE_EQ(clear.motp, 1.0);
  EXPECT_EQ(clear.mostly_tracked, 2U);
}

TEST(ClearMot, CountsMissesFalseRowsAndSwitchesAgainstTheObjects) {
  const ClearMot clear =
      clear_mot({1,
                 3,
                 {scan({{0, 0.0}}, {{0, 0.0}}),  // right
                  scan({{0, 0.0}}, {}),          // missed
                  // right by another track: a switch; one false
                  scan({{0, 0.0}}, {{1, 0.0}, {2, 9.0}}), scan({{0, 0.0}}, {{1, 0.0}})}},
                0.5);
  EXPECT_EQ(clear.true_positives, 3U);
  EXPECT_EQ(clear.misses, 1U);
  EXPECT_EQ(clear.false_positives, 1U);
  EXPECT_EQ(clear.switches, 1U);
  EXPECT_DOUBLE_EQ(clear.mota, 1.0 - 3.0 / 4.0);
  EXPECT_DOUBLE_EQ(clear.recall, 0.75);
  EXPECT_DOUBLE_EQ(clear.precision, 0.75);
}

TEST(ClearMot, KeepsAPairThatStillMayBeThoughAnotherIsNearer) {
  const ClearMot clear = clear_mot(
      {1, 2, {scan({{0, 0.0}}, {{0, 0.0}}), scan({{0, 0.0}}, {{0, 0.4}, {1, 0.0}})}}, 0.5);
  EXPECT_EQ(clear.switches, 0U);
  EXPECT_EQ(clear.matches[1].front().track, 0U);
}

TEST(ClearMot, DoesNotMatchBelowTheGate) {
  EXPECT_EQ(clear_mot({1, 1, {scan({{0, 0.0}}, {{0, 0.51}})}}, 0.5).true_positives, 0U);
  EXPECT_EQ(clear_mot({1, 1, {scan({{0, 0.0}}, {{0, 0.5}})}}, 0.5).true_positives, 1U);
}

TEST(ClearMot, CountsAFragmentationWhenAnObjectIsFoundAgain) {
  const auto seen = scan({{0, 0.0}}, {{0, 0.0}});
  const auto lost = scan({{0, 0.0}}, {{0, 5.0}});
  EXPECT_EQ(clear_mot({1, 1, {seen, lost, seen, lost, seen}}, 0.5).fragmentations, 2U);
}

TEST(ClearMot, OfNoTracksMissesEverything) {
  const ClearMot clear = clear_mot({1, 0, {scan({{0, 0.0}}, {}), scan({{0, 0.0}}, {})}}, 0.5);
  EXPECT_EQ(clear.misses, 2U);
  EXPECT_EQ(clear.mota, 0.0);
  EXPECT_EQ(clear.mostly_lost, 1U);
}

}  // namespace
}  // namespace slammot::metrics
