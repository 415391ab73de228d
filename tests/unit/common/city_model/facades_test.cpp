#include "common/city_model/facades.hpp"

#include <cmath>

#include <gtest/gtest.h>

namespace slammot::city_model {
namespace {

constexpr double kCell_m = 0.5;

void put(Columns& columns, double x_m, double y_m, double z_m) {
  const Eigen::Vector3f position_m(static_cast<float>(x_m), static_cast<float>(y_m),
                                   static_cast<float>(z_m));
  columns[cell_of(position_m, kCell_m)].push_back({position_m, 0, 0});
}

/// A wall along a line through (1, 2) with this heading, 6 m long, scanned every 0.25 m.
Columns wall(double heading_rad, double bottom_m, double top_m) {
  Columns columns;
  for (double along_m = 0.0; along_m < 6.0; along_m += 0.25) {
    for (double z_m = bottom_m; z_m <= top_m; z_m += 0.2)
      put(columns, 1.0 + along_m * std::cos(heading_rad), 2.0 + along_m * std::sin(heading_rad),
          z_m);
  }
  return columns;
}

double distance_to_line_m(const geometry::Vector2& point, double heading_rad) {
  return std::abs(-(point.x() - 1.0) * std::sin(heading_rad) +
                  (point.y() - 2.0) * std::cos(heading_rad));
}

TEST(Facades, LieOnAWallOfAnyHeadingFromTheRoadToItsTop) {
  for (const double heading_rad : {0.1, 0.8, 1.5, 2.6}) {
    const auto facades = facades_of(wall(heading_rad, 0.5, 9.9), kCell_m);
    double length_m = 0.0;
    for (const Facade& facade : facades) {
      EXPECT_LT(distance_to_line_m(facade.from_m, heading_rad), 0.03);
      EXPECT_LT(distance_to_line_m(facade.to_m, heading_rad), 0.03);
      EXPECT_EQ(facade.bottom_m, 0.0);
      EXPECT_NEAR(facade.top_m, 9.9, 0.2);
      length_m += (facade.to_m - facade.from_m).norm();
    }
    EXPECT_NEAR(length_m, 6.0, 1.0) << heading_rad;
  }
}

TEST(Facades, OfWhatHangsAboveTheRoadBeginAtItsLowestEcho) {
  for (const Facade& facade : facades_of(wall(0.1, 3.0, 5.0), kCell_m))
    EXPECT_NEAR(facade.bottom_m, 3.0, 0.01);
}

TEST(Facades, OfAPoleAreAsWideAsItsEchoes) {
  Columns columns;
  for (int i = 0; i < 20; ++i) put(columns, 3.25 + 0.05 * (i % 2), 3.25, 0.5 + 0.2 * i);
  const auto facades = facades_of(columns, kCell_m);
  ASSERT_EQ(facades.size(), 1U);
  EXPECT_LT((facades[0].to_m - facades[0].from_m).norm(), 0.15);
}

TEST(Facades, NeedSeveralEchoes) {
  Columns columns;
  put(columns, 0.1, 0.1, 2.0);
  put(columns, 0.1, 0.1, 2.2);
  EXPECT_TRUE(facades_of(columns, kCell_m).empty());
}

TEST(SpanOf, LeavesOutASingleEchoFarAbove) {
  std::vector<PlacedEcho> echoes;
  for (const float z_m : {0.5F, 1.0F, 1.5F, 2.0F, 9.0F})
    echoes.push_back({Eigen::Vector3f(0.0F, 0.0F, z_m), 0, 0});
  EXPECT_NEAR(span_of(echoes).top_m, 2.0, 1e-6);
  EXPECT_NEAR(span_of(echoes).bottom_m, 0.5, 1e-6);
}

}  // namespace
}  // namespace slammot::city_model
