#include "common/matching/occupancy_patch.hpp"

#include <cmath>

#include <gtest/gtest.h>

namespace slammot::matching {
namespace {

using geometry::Matrix2;
using geometry::Pose2;
using geometry::Vector2;

constexpr double kCell_m = 0.1;

UncertainPoint point_at(double x_m, double y_m, double sigma_m = 0.1) {
  return {{x_m, y_m}, sigma_m * sigma_m * Matrix2::Identity()};
}

TEST(OccupancyPatch, SpreadsAnEchoAsItsNoiseDoes) {
  const std::vector<UncertainPoint> points = {
      {{0.05, 0.05}, Eigen::Vector2d(0.09, 0.01).asDiagonal()}};
  const OccupancyPatch patch(points, kCell_m);
  const double middle = patch.evidence_at({0.05, 0.05});
  const double variance_x_m2 = 0.09 + kCell_m * kCell_m / 12.0,
               variance_y_m2 = 0.01 + kCell_m * kCell_m / 12.0;
  EXPECT_NEAR(patch.evidence_at({0.35, 0.05}), middle * std::exp(-0.5 * 0.09 / variance_x_m2),
              1e-5);
  EXPECT_NEAR(patch.evidence_at({0.05, 0.25}), middle * std::exp(-0.5 * 0.04 / variance_y_m2),
              1e-5);
  EXPECT_EQ(patch.evidence_at({5.0, 0.0}), 0.0);
}

TEST(OccupancyPatch, AddsTheLogOddsOfWhatSeveralEchoesSayOfOneCell) {
  const auto log_odds = [](const OccupancyPatch& patch) {
    return 2.0 * std::atanh(patch.evidence_at({0.05, 0.05}));
  };
  const std::vector<UncertainPoint> one = {point_at(0.05, 0.05)};
  const std::vector<UncertainPoint> three(3, one.front());
  EXPECT_NEAR(log_odds(OccupancyPatch(three, kCell_m)),
              3.0 * log_odds(OccupancyPatch(one, kCell_m)), 1e-4);
}

TEST(OccupancyPatch, SaysMoreWhereTheMeasurementIsSurer) {
  const std::vector<UncertainPoint> sure = {point_at(0.05, 0.05, 0.05)};
  const std::vector<UncertainPoint> unsure = {point_at(0.05, 0.05, 0.3)};
  EXPECT_GT(OccupancyPatch(sure, kCell_m).evidence_at({0.05, 0.05}),
            4.0 * OccupancyPatch(unsure, kCell_m).evidence_at({0.05, 0.05}));
  EXPECT_LT(OccupancyPatch(sure, kCell_m).evidence_at({0.45, 0.05}),
            OccupancyPatch(unsure, kCell_m).evidence_at({0.45, 0.05}));
}

TEST(OccupancyPatch, ListsItsOccupiedCellsAndNoOthers) {
  const OccupancyPatch patch(std::vector<UncertainPoint>{point_at(1.05, -2.05)}, kCell_m);
  const auto cells = patch.occupied(0.01);
  ASSERT_FALSE(cells.empty());
  for (const OccupiedCell& cell : cells) {
    EXPECT_NEAR(patch.evidence_at(cell.centre_m), cell.evidence, 1e-6);
    EXPECT_GE(cell.evidence, 0.01);
    EXPECT_LT((cell.centre_m - Vector2(1.05, -2.05)).norm(), 0.5);
  }
  EXPECT_TRUE(OccupancyPatch({}, kCell_m).occupied(0.0).empty());
}

TEST(Correlation, IsHighestWhereThePatchesLieOnEachOther) {
  std::vector<UncertainPoint> corner;
  for (double at_m = 0.0; at_m < 2.0; at_m += 0.1) {
    corner.push_back(point_at(at_m, 0.0));
    corner.push_back(point_at(0.0, at_m));
  }
  const OccupancyPatch target(corner, kCell_m);
  const auto source = OccupancyPatch(corner, kCell_m).occupied(0.05);
  const double on_each_other = correlation(target, source, {});
  EXPECT_LT(on_each_other, 1.0);
  double before = on_each_other;
  for (const double away_m : {0.05, 0.1, 0.2, 0.3, 0.4, 0.5}) {
    const double now = correlation(target, source, {away_m, away_m, 0.0});
    EXPECT_LT(now, before);
    before = now;
  }
  EXPECT_EQ(correlation(target, source, Pose2{50.0, 0.0, 0.0}), 0.0);
  EXPECT_EQ(correlation(target, {}, Pose2{}), 0.0);
}

}  // namespace
}  // namespace slammot::matching
