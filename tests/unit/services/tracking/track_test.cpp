#include "services/tracking/track.hpp"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

namespace slammot::tracking {
namespace {

constexpr double kPeriodS = 0.027;

TEST(Answers, AreSupposedToBeManyBeforeAnythingIsKnown) { EXPECT_LT(Answers().unanswered_share(), 0.3); }

TEST(Answers, OfSomethingDarkAreStillKnownToBeFewWhenOneEchoIsAllThatIsSeen) {
  Answers answers;
  for (int scan = 0; scan < 20; ++scan) answers = with_answers(answers, 4, 8, kPeriodS);
  answers = with_answers(answers, 1, 0, kPeriodS);
  EXPECT_NEAR(answers.unanswered_share(), 0.8, 0.05);  // of the ten between the two outermost
}

TEST(Answers, AreForgottenAfterAWhile) {
  Answers answers = with_answers({}, 4, 8, kPeriodS);
  for (int scan = 0; scan < 200; ++scan) answers = with_answers(answers, 10, 0, kPeriodS);
  EXPECT_LT(answers.unanswered_share(), 0.05);
}

TEST(Track, LiesAlongWhatIsLongerThanAnyFront) {
  const TrackingConfig config;
  std::vector<Eigen::Vector2d> points;
  const auto flank_m = [&](double length_m) {
    points.clear();
    for (double y = 0.0; y < length_m; y += 0.2) points.emplace_back(20.0, y);
    Glimpse glimpse;
    glimpse.points_m = points;
    glimpse.beam_step_rad = 0.5 * M_PI / 180.0;
    glimpse.start = glimpse.end = Edge::kHidden;
    return glimpse;
  };
  Track track = begun({1}, 0, flank_m(2.0), 0.5 * M_PI, 1e-4 * Eigen::Matrix2d::Identity(), config);
  ASSERT_LT(std::abs(std::sin(track.body.heading_rad)), 0.1);  // as wide as the rear of a car
  std::int64_t stamp_ns = 0;
  for (int scan = 0; scan < 20; ++scan) {
    predict(track, kPeriodS, config);
    ASSERT_TRUE(update(track, stamp_ns += 27'000'000, flank_m(3.1), 1e-4 * Eigen::Matrix2d::Identity(), config));
  }
  EXPECT_GT(std::abs(std::sin(track.body.heading_rad)), 0.9);
}

}  // namespace
}  // namespace slammot::tracking
