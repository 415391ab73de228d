#include "common/metrics/detection.hpp"

#include <initializer_list>

#include <gtest/gtest.h>

#include "tests/unit/common/metrics/scenes.hpp"

namespace slammot::metrics {
namespace {

const CountingRule kRule;

std::vector<BeamTruth> beams(std::initializer_list<BeamKind> kinds) {
  std::vector<BeamTruth> truth;
  for (const BeamKind kind : kinds) truth.push_back({kind, 4});
  return truth;
}

constexpr BeamKind M = BeamKind::kMoving;
constexpr BeamKind S = BeamKind::kStationary;
constexpr BeamKind X = BeamKind::kDontCare;

TEST(BeamTruth, IsMovingOnAMovingBoxAndUndecidedBesideIt) {
  const Scene scene{0, {}, {car_at(10.0, 0.0, 4)}, {}};  // its rear end is at 8 m
  const auto truth = beam_truth(
      {{{7.8, 0.0}}, {{7.3, 0.0}}, {{6.0, 0.0}}, std::nullopt, {{60.0, 0.0}}}, scene, kRule);
  EXPECT_EQ(truth[0].kind, M);
  EXPECT_EQ(truth[0].object, 4U);
  EXPECT_EQ(truth[1].kind, X);
  EXPECT_EQ(truth[2].kind, S);
  EXPECT_EQ(truth[3].kind, BeamKind::kNoEcho);
  EXPECT_EQ(truth[4].kind, X);
}

TEST(BeamTruth, IsWhatTheBeamsAreKnownToHaveHit) {
  TrueObject standing = car_at(20.0, 0.0, 5);
  standing.speed_mps = 0.0;
  const Scene scene{0, {}, {car_at(10.0, 0.0, 4), standing}, {}};
  using On = BeamHit::On;
  const std::vector<BeamHit> hits = {{On::kStationary}, {On::kObject, 4}, {On::kObject, 5},
                                     {On::kSeveral},    {On::kNothing},   {On::kStationary},
                                     {On::kObject, 9}};
  const auto truth = beam_truth({{{8.0, 0.0}},
                                 {{5.0, 0.0}},
                                 {{20.0, 0.0}},
                                 {{9.0, 0.0}},
                                 std::nullopt,
                                 {{60.0, 0.0}},
                                 {{7.0, 0.0}}},
                                hits, scene, kRule);
  EXPECT_EQ(truth[0].kind, S);  // though on the car
  EXPECT_EQ(truth[1].kind, M);  // though away from it
  EXPECT_EQ(truth[1].object, 4U);
  EXPECT_EQ(truth[2].kind, BeamKind::kStanding);
  EXPECT_EQ(truth[3].kind, X);
  EXPECT_EQ(truth[4].kind, BeamKind::kNoEcho);
  EXPECT_EQ(truth[5].kind, X);
  EXPECT_EQ(truth[6].kind, X);
}

TEST(BeamTruth, TakesNoMoreEchoesThanTheObjectSent) {
  TrueObject walker = car_at(10.0, 0.0);
  walker.length_m = walker.width_m = 0.5;
  walker.points = 2;
  const auto truth = beam_truth({{{9.75, -0.1}}, {{9.75, 0.1}}, {{10.3, 0.3}}},
                                {0, {}, {walker}, {}}, kRule);  // the third is of a wall behind
  EXPECT_EQ(truth[0].kind, M);
  EXPECT_EQ(truth[1].kind, M);
  EXPECT_EQ(truth[2].kind, X);
}

TEST(BeamTruth, DoesNotAskAboutAnObjectThatStands) {
  TrueObject car = car_at(10.0, 0.0);
  car.speed_mps = 0.1;
  EXPECT_EQ(beam_truth({{{8.0, 0.0}}}, {0, {}, {car}, {}}, kRule)[0].kind, BeamKind::kStanding);
}

TEST(Detection, CountsPointsByTruthAndLabel) {
  const DetectionCounts counts = add_scan({}, beams({M, M, M, M, S, S, S, X}), "mms?smsm", 3);
  EXPECT_EQ(counts.moving_as_moving, 2U);
  EXPECT_EQ(counts.moving_as_stationary, 1U);
  EXPECT_EQ(counts.moving_as_unknown, 1U);
  EXPECT_EQ(counts.stationary_as_moving, 1U);
  EXPECT_DOUBLE_EQ(counts.moving_precision(), 2.0 / 3.0);
  EXPECT_DOUBLE_EQ(counts.moving_recall(), 0.5);
  EXPECT_DOUBLE_EQ(counts.stationary_precision(), 2.0 / 3.0);
  EXPECT_DOUBLE_EQ(counts.stationary_recall(), 2.0 / 3.0);
}

TEST(Detection, FindsAnObjectWhenMostOfItsDecidedPointsMove) {
  EXPECT_EQ(add_scan({}, beams({M, M, M, M}), "m???", 3).detected_objects, 1U);
  EXPECT_EQ(add_scan({}, beams({M, M, M, M}), "mss?", 3).detected_objects, 0U);
  EXPECT_EQ(add_scan({}, beams({M, M, S, S}), "mm--", 3).objects, 0U);  // too few points
}

TEST(Detection, JudgesRunsOfMovingLabelsByWhatMostOfThemHit) {
  const DetectionCounts counts =
      add_scan({}, beams({M, M, S, S, S, S, S, X, X, X}), "mmmsmmmsmm", 3);
  EXPECT_EQ(counts.moving_runs, 2U);  // the last run is of don't-care points
  EXPECT_EQ(counts.right_runs, 1U);
  EXPECT_DOUBLE_EQ(counts.segment_precision(), 0.5);
}

TEST(Detection, IgnoresLabelsOfAnotherScanner) {
  EXPECT_EQ(add_scan({}, beams({M, M, M}), "mm", 3).objects, 0U);
}

}  // namespace
}  // namespace slammot::metrics
