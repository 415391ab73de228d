#include "common/metrics/hota.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "tests/unit/common/metrics/sequence.hpp"

namespace slammot::metrics {
namespace {

TEST(Hota, OfPerfectTracksIsOne) {
  const auto all = scan({{0, 0.0}, {1, 5.0}}, {{0, 0.0}, {1, 5.0}});
  const Hota result = hota({2, 2, {all, all, all}});
  EXPECT_NEAR(result.hota, 1.0, 1e-12);
  EXPECT_NEAR(result.localization_accuracy, 1.0, 1e-12);
}

TEST(Hota, OfAnObjectFollowedByTwoTracksInTurnIsTheRootOfAHalf) {
  // Detection is perfect. Each of four rows belongs to a track that has two of the object's four
  // rows: Jaccard 1/2.
  const auto first = scan({{0, 0.0}}, {{0, 0.0}});
  const auto second = scan({{0, 0.0}}, {{1, 0.0}});
  const Hota result = hota({1, 2, {first, first, second, second}});
  EXPECT_NEAR(result.detection_accuracy, 1.0, 1e-12);
  EXPECT_NEAR(result.association_accuracy, 0.5, 1e-12);
  EXPECT_NEAR(result.hota, std::sqrt(0.5), 1e-12);
}

TEST(Hota, OfTracksOffByTheSimilarityOfAHalfCountsInTenOfNineteenThresholds) {
  const auto off = scan({{0, 0.0}}, {{0, 0.5}});
  EXPECT_NEAR(hota({1, 1, {off, off}}).hota, 10.0 / 19.0, 1e-12);
}

TEST(Hota, OfATrackThatIsThereHalfTheTimeHasHalfOfEach) {
  const auto seen = scan({{0, 0.0}}, {{0, 0.0}});
  const auto missed = scan({{0, 0.0}}, {});
  const Hota result = hota({1, 1, {seen, missed}});
  EXPECT_NEAR(result.detection_accuracy, 0.5, 1e-12);
  EXPECT_NEAR(result.association_accuracy, 0.5, 1e-12);
  EXPECT_NEAR(result.hota, 0.5, 1e-12);
}

TEST(Hota, OfNothingIsZero) { EXPECT_EQ(hota({}).hota, 0.0); }

}  // namespace
}  // namespace slammot::metrics
