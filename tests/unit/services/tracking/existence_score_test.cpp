#include "services/tracking/existence_score.hpp"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "services/tracking/confirmation.hpp"
#include "services/tracking/measurement_update.hpp"
#include "services/tracking/termination.hpp"
#include "services/tracking/track_initiation.hpp"
#include "tests/support/example_tracks.hpp"

namespace slammot::tracking {
namespace {

using testing::followed_car;
using testing::kPeriodS;

/// A rear, as wide as one of a car and so deep, at which so much is added to the place now and
/// then.
double score_after_two_seconds(double depth_m, double jump_m) {
  const TrackingConfig config;
  std::vector<Eigen::Vector2d> points;
  Observation observation;
  observation.beam_step_rad = 0.5 * M_PI / 180.0;
  Track track;
  std::int64_t stamp_ns = 0;
  for (int scan = 0; scan < 74; ++scan) {
    points.clear();
    const double x_m = 20.0 + 5.0 * kPeriodS * scan + (scan % 2 == 0 ? jump_m : 0.0);
    for (int i = 0; i < 10; ++i) points.emplace_back(x_m + depth_m * (i % 3) / 2.0, -0.9 + 0.2 * i);
    observation.points_m = points;
    if (scan == 0)
      track =
          initiated({{1}, stamp_ns, observation, 0.0, 1e-4 * Eigen::Matrix2d::Identity()}, config);
    predict(track, scan == 0 ? 0.0 : kPeriodS, config);
    EXPECT_TRUE(update(track, stamp_ns, observation, 1e-4 * Eigen::Matrix2d::Identity(), config));
    score_hit(track, {flow::PointLabel::kMoving, {8.0, 0.0, 2.0}, kPeriodS}, config);
    stamp_ns += 27'000'000;
  }
  return track.existence.score;
}

TEST(ExistenceScore, IsBelievedInLessWhereMoreBeamsPassThroughTheMiddleOfItThanAreEchoed) {
  const Visibility seen{10, 0, 8, 0};
  Track track = followed_car();
  track.existence.mapped_share = 0.5;
  score_passed(track, seen, 8);
  EXPECT_EQ(track.existence.score, 5.0);
  score_passed(track, seen, 2);
  EXPECT_LT(track.existence.score, 4.0);
}

/// After 30 scans, each third with a moving echo and the others with so many beams through it.
double score_of_rare_answers(Track track, int beams) {
  const TrackingConfig config;
  track.existence.score = 0.0;
  for (int scan = 0; scan < 30; ++scan)
    if (scan % 3 < 2) score_miss(track, {beams, 0, beams, 0}, kPeriodS, config);
    else score_hit(track, {flow::PointLabel::kMoving, {1.0, 0.0, 0.0}, kPeriodS}, config);
  return track.existence.score;
}

TEST(ExistenceScore, OfAPedestrianFarAwayRisesThoughTwoOfThreeScansHaveNoEcho) {
  const Track walker = testing::known_walker(20.0, {});
  EXPECT_GT(score_of_rare_answers(walker, 1), kConfirmScore);
  EXPECT_LT(score_of_rare_answers(walker, 6), kRejectScore);  // a near one would send echoes
  EXPECT_LT(score_of_rare_answers(followed_car(), 1), kRejectScore);
}

TEST(ExistenceScore, OfWhatTheMapContradictsIsSomethingThoughItIsDrawnTooLarge) {
  Track track = followed_car();
  track.existence.mapped_share = 0.0;
  score_passed(track, {10, 0, 8, 0}, 2);
  EXPECT_EQ(track.existence.score, 5.0);
}

TEST(ExistenceScore, IsFilledInTheMiddleAsFarAsItsSizeAndPlaceAreKnown) {
  Track track = followed_car();
  EXPECT_NEAR(interior_of(track).length.value_m, 4.4 - 0.2 - 2.0 * 0.1, 1e-9);
  EXPECT_NEAR(interior_of(track).width.value_m, 1.8 - 0.1 - 2.0 * 0.1, 1e-9);
  track.extent.footprint().length.variance_m2 = 9.0;
  EXPECT_GT(interior_of(track).length.value_m, 0.0);
}

TEST(ExistenceScore, IsNotBelievedInIfItsEchoesNeitherLieOnItsSidesNorComeFromWhereItShouldBe) {
  EXPECT_GT(score_after_two_seconds(0.0, 0.0), 5.0);
  EXPECT_GT(score_after_two_seconds(0.0, 0.3), 5.0) << "a body like any, for all its jumps";
  EXPECT_GT(score_after_two_seconds(1.5, 0.0), 5.0) << "something, but drawn wrong";
  EXPECT_LT(score_after_two_seconds(1.5, 0.3), 0.0) << "twigs";
}

}  // namespace
}  // namespace slammot::tracking
