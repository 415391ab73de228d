#include "services/tracking/extent_statistics.hpp"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/example_tracks.hpp"

namespace slammot::tracking {
namespace {

using testing::kPeriodS;

TEST(ResponseRate, AreSupposedToBeManyBeforeAnythingIsKnown) {
  EXPECT_LT(ResponseRate().unanswered_share(), 0.3);
}

TEST(ResponseRate, OfSomethingDarkAreStillKnownToBeFewWhenOneEchoIsAllThatIsSeen) {
  ResponseRate responses;
  for (int scan = 0; scan < 20; ++scan) responses = with_responses(responses, 4, 8, kPeriodS);
  responses = with_responses(responses, 1, 0, kPeriodS);
  EXPECT_NEAR(responses.unanswered_share(), 0.8, 0.05);  // of the ten between the two outermost
}

TEST(ResponseRate, AreForgottenAfterAWhile) {
  ResponseRate responses = with_responses({}, 4, 8, kPeriodS);
  for (int scan = 0; scan < 200; ++scan) responses = with_responses(responses, 10, 0, kPeriodS);
  EXPECT_LT(responses.unanswered_share(), 0.05);
}

}  // namespace
}  // namespace slammot::tracking
