// What Wang 2004 claims of multiple models: Section 2.3 of the mixtures, Chapter 4 of the models.
#include "examples/motion_study/scores.hpp"

#include <algorithm>

#include <gtest/gtest.h>

#include "examples/motion_study/report.hpp"

namespace slammot::motion_study {
namespace {

using simulation::Maneuver;

constexpr int kSeeds = 20;
constexpr double kSettledS = 1.0;
const Span kAtRest{simulation::kStandsAtS + 2.0, simulation::kStartsAtS};

Maneuver maneuver_named(std::string_view name) {
  for (const Maneuver& maneuver : simulation::thesis_maneuvers()) {
    if (maneuver.name == name) return maneuver;
  }
  ADD_FAILURE() << name;
  return {};
}

Score of(Method method, std::string_view name) {
  const Maneuver maneuver = maneuver_named(name);
  return score_of(method, maneuver, {kSettledS, maneuver.duration_s}, kSeeds);
}

Score at_rest(Method method) {
  return score_of(method, maneuver_named("move-stop-move"), kAtRest, kSeeds);
}

TEST(MultipleModels, ImmErrsAsGpb2AndLessThanGpb1InEveryManeuver) {  // Section 2.3
  for (const Maneuver& maneuver : simulation::thesis_maneuvers()) {
    const Score gpb1 = of(Method::kGpb1, maneuver.name);
    const Score gpb2 = of(Method::kGpb2, maneuver.name);
    const Score imm = of(Method::kImm, maneuver.name);
    EXPECT_NEAR(imm.velocity_rmse_mps / gpb2.velocity_rmse_mps, 1.0, 0.1) << maneuver.name;
    EXPECT_NEAR(imm.position_rmse_m / gpb2.position_rmse_m, 1.0, 0.1) << maneuver.name;
    EXPECT_LT(imm.velocity_rmse_mps, 0.9 * gpb1.velocity_rmse_mps) << maneuver.name;
  }
}

TEST(MultipleModels, ImmRunsAsManyFiltersAsGpb1AndGpb2TheirSquare) {
  EXPECT_EQ(filters_of(Method::kImm), filters_of(Method::kGpb1));
  EXPECT_EQ(filters_of(Method::kGpb2), filters_of(Method::kImm) * filters_of(Method::kImm));
}

TEST(MultipleModels, FollowBothKindsOfMotionAndOneModelOnlyItsOwn) {  // Figures 4.2 to 4.5
  EXPECT_GT(of(Method::kConstantVelocity, "constant acceleration").velocity_rmse_mps,
            4.0 * of(Method::kImm, "constant acceleration").velocity_rmse_mps);
  EXPECT_GT(of(Method::kConstantAcceleration, "constant velocity").velocity_rmse_mps,
            2.0 * of(Method::kImm, "constant velocity").velocity_rmse_mps);
}

TEST(MultipleModels, AreConsistentWhereOneModelIsOverconfident) {
  EXPECT_GT(of(Method::kConstantVelocity, "move-stop-move").position_nees, 10.0);
  for (const Method method : {Method::kGpb2, Method::kImm, Method::kMoveStop}) {
    EXPECT_LT(of(method, "move-stop-move").position_nees, 2.6) << name_of(method);
    EXPECT_GT(of(method, "move-stop-move").position_nees, 1.4) << name_of(method);
  }
}

TEST(MultipleModels, DecideLaterForAModeByGpb1ThanByTheImm) {
  const Maneuver maneuver = maneuver_named("move-stop-move");
  const double imm_s = *mode_delay_s(Method::kImm, maneuver, kSeeds);
  EXPECT_LT(imm_s, 0.7);
  EXPECT_GT(*mode_delay_s(Method::kGpb1, maneuver, kSeeds), 1.3 * imm_s);
  EXPECT_NEAR(*mode_delay_s(Method::kGpb2, maneuver, kSeeds), imm_s, 0.1);
}

TEST(ModeDelay, IsNotDefinedForOneModelOrWithoutChanges) {
  EXPECT_FALSE(mode_delay_s(Method::kConstantVelocity, maneuver_named("move-stop-move"), 1));
  EXPECT_FALSE(mode_delay_s(Method::kImm, maneuver_named("turn"), 1));
}

TEST(CoordinatedTurn, FollowsATurnBetterThanConstantAcceleration) {  // on Figure 4.7
  EXPECT_LT(of(Method::kImmWithTurn, "turn").velocity_rmse_mps,
            0.7 * of(Method::kImm, "turn").velocity_rmse_mps);
}

TEST(MoveStopHypothesis, RestsWhereTheImmMovesAboutTheTruePlace) {  // Figures 4.8, 4.17, 4.18
  const Score imm = at_rest(Method::kImm);
  const Score move_stop = at_rest(Method::kMoveStop);
  EXPECT_GT(imm.velocity_rmse_mps, 0.1);
  EXPECT_LT(move_stop.velocity_rmse_mps, 0.2 * imm.velocity_rmse_mps);
  EXPECT_LT(move_stop.position_rmse_m, 0.6 * imm.position_rmse_m);
}

TEST(MoveStopHypothesis, RestsCloserToTheTruePlaceThanAStopModelInTheMixture) {  // Section 4.5
  EXPECT_LT(at_rest(Method::kMoveStop).position_rmse_m,
            at_rest(Method::kImmWithStop).position_rmse_m);
  EXPECT_LT(at_rest(Method::kMoveStop).velocity_rmse_mps,
            0.5 * at_rest(Method::kImmWithStop).velocity_rmse_mps);
}

TEST(MoveStopHypothesis, CostsNothingWhereTheObjectMoves) {
  for (const std::string_view name : {"constant velocity", "turn"}) {
    EXPECT_NEAR(of(Method::kMoveStop, name).position_rmse_m, of(Method::kImm, name).position_rmse_m,
                1e-9);
  }
}

TEST(Report, HasARowForEveryMethodInEveryTable) {
  const std::string text = tables(1);
  for (const Method method : kMethods)
    EXPECT_NE(text.find("| " + std::string(name_of(method)) + " |"), std::string::npos);
  EXPECT_NE(text.find("move-stop-move, at rest"), std::string::npos);
}

TEST(Report, TracesEveryMeasurementOfEveryMethod) {
  const std::string text = traces(1);
  std::size_t measurements = 0;
  for (const Maneuver& maneuver : simulation::thesis_maneuvers())
    measurements += simulation::measured_positions_m(maneuver, 1).size();
  EXPECT_EQ(static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n')),
            1 + measurements * kMethods.size());
}

}  // namespace
}  // namespace slammot::motion_study
