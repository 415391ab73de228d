#include "common/metrics/prediction_errors.hpp"

#include <gtest/gtest.h>

#include "common/metrics/clear_mot.hpp"
#include "tests/unit/common/metrics/scenes.hpp"

namespace slammot::metrics {
namespace {

constexpr std::int64_t kSecondNs = 1'000'000'000;

ReportedTrack track_that_predicts(double x_m, double after_s, double there_m) {
  ReportedTrack track = track_at(x_m, 0.0);
  track.predicted = {{after_s, {there_m, 0.0}, geometry::Matrix2::Identity() * 0.25}};
  return track;
}

std::vector<PredictionErrors> errors_of(const std::vector<Scene>& scenes) {
  std::vector<CountedScene> counted;
  MotSequence sequence{1, 1, {}};
  for (const Scene& scene : scenes) {
    counted.push_back(count_scene(scene, {}));
    sequence.frames.push_back(counted.back().frame);
  }
  return prediction_errors(scenes, counted, clear_mot(sequence, 0.5).matches);
}

TEST(PredictionErrors, AreDistancesToWhereTheObjectIsThen) {
  const auto errors =
      errors_of({{0, {}, {car_at(10.0, 0.0)}, {track_that_predicts(10.0, 1.0, 21.0)}},
                 {kSecondNs, {}, {car_at(20.0, 0.0)}, {}}});
  ASSERT_EQ(errors.size(), 1U);
  EXPECT_EQ(errors[0].after_s, 1.0);
  EXPECT_NEAR(errors[0].displacement_m.rmse, 1.0, 1e-12);
  EXPECT_NEAR(errors[0].nees.mean, 4.0, 1e-12);  // two standard deviations
  EXPECT_EQ(errors[0].inside_share, 1.0);
}

TEST(PredictionErrors, TakeTheTruthFromBetweenTwoScans) {
  const auto errors =
      errors_of({{0, {}, {car_at(10.0, 0.0)}, {track_that_predicts(10.0, 0.15, 11.5)}},
                 {kSecondNs / 10, {}, {car_at(11.0, 0.0)}, {}},
                 {kSecondNs / 5, {}, {car_at(12.0, 0.0)}, {}}});
  ASSERT_EQ(errors.size(), 1U);
  EXPECT_NEAR(errors[0].displacement_m.rmse, 0.0, 1e-12);
}

TEST(PredictionErrors, LeaveOutTimesOfWhichTheTruthKnowsNothing) {
  EXPECT_TRUE(errors_of({{0, {}, {car_at(10.0, 0.0)}, {track_that_predicts(10.0, 3.0, 40.0)}},
                         {kSecondNs, {}, {car_at(20.0, 0.0)}, {}}})
                  .empty());
  EXPECT_TRUE(errors_of({{0, {}, {car_at(10.0, 0.0)}, {track_that_predicts(10.0, 0.5, 15.0)}},
                         {kSecondNs, {}, {car_at(20.0, 0.0)}, {}}})
                  .empty());
}

TEST(PredictionErrors, TakeOneNeesSampleASecond) {
  std::vector<Scene> scenes;
  for (int i = 0; i < 41; ++i)
    scenes.push_back({i * kSecondNs / 10,
                      {},
                      {car_at(10.0 + i, 0.0)},
                      {track_that_predicts(10.0 + i, 1.0, 20.0 + i)}});
  const auto errors = errors_of(scenes);
  ASSERT_EQ(errors.size(), 1U);
  EXPECT_EQ(errors[0].displacement_m.count, 31U);
  EXPECT_EQ(errors[0].nees.samples, 4U);
}

}  // namespace
}  // namespace slammot::metrics
