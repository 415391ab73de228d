#include "services/tracking/body_contour.hpp"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

namespace slammot::tracking {
namespace {

using Eigen::Vector2d;
using Eigen::Vector2f;

constexpr double kPieceM = 0.5;

/// A car of 4 m by 2 m.
Footprint car(double heading_rad = 0.0) {
  Footprint footprint;
  footprint.heading_rad = heading_rad;
  footprint.length = {4.0, 0.01};
  footprint.width = {2.0, 0.01};
  return footprint;
}

/// Echoes on the left flank in its own frame, from the rear on.
std::vector<Vector2d> left_flank() {
  std::vector<Vector2d> points_m;
  for (double x_m = -1.9; x_m < 1.95; x_m += 0.1) points_m.emplace_back(x_m, 1.0);
  return points_m;
}

std::vector<Vector2d> rear() {
  std::vector<Vector2d> points_m;
  for (double y_m = -0.9; y_m < 0.95; y_m += 0.1) points_m.emplace_back(-2.0, y_m);
  return points_m;
}

std::vector<Vector2d> moved(std::vector<Vector2d> points_m, double heading_rad,
                            const Vector2d& centre_m) {
  for (Vector2d& point_m : points_m) point_m = centre_m + Eigen::Rotation2Dd(heading_rad) * point_m;
  return points_m;
}

std::vector<Vector2f> in_box(const BodyContour& contour) {
  std::vector<Vector2f> points_m;
  put_contour(contour, 0.0, Vector2d::Zero(), kMostContourPoints, points_m);
  return points_m;
}

TEST(BodyContour, HoldsWhatSeveralViewsShowedOfABodyThatTurns) {
  BodyContour contour;
  add_echoes(contour, car(), {10.0, 0.0}, moved(left_flank(), 0.0, {10.0, 0.0}), kPieceM);
  const std::size_t flank = contour.points.size();
  EXPECT_EQ(flank, 8U) << "pieces of half a metre";
  add_echoes(contour, car(1.2), {14.0, 3.0}, moved(rear(), 1.2, {14.0, 3.0}), kPieceM);
  EXPECT_EQ(contour.points.size(), flank + 4U);
  for (const Vector2f& at_m : in_box(contour))
    EXPECT_NEAR(std::max(std::abs(at_m.x()) - 2.0F, std::abs(at_m.y()) - 1.0F), 0.0F, 1e-4F);
}

TEST(BodyContour, IsOrderedCounterClockwise) {
  BodyContour contour;
  add_echoes(contour, car(), Vector2d::Zero(), rear(), kPieceM);
  add_echoes(contour, car(), Vector2d::Zero(), left_flank(), kPieceM);
  const std::vector<Vector2f> points_m = in_box(contour);
  for (std::size_t i = 1; i < points_m.size(); ++i)
    EXPECT_GT(points_m[i - 1].x() * points_m[i].y() - points_m[i - 1].y() * points_m[i].x(), 0.0F);
}

TEST(BodyContour, AveragesEchoesOfOnePiece) {
  BodyContour contour;
  const std::vector<Vector2d> near = {{0.2, 0.95}};
  const std::vector<Vector2d> far = {{0.3, 1.05}};
  add_echoes(contour, car(), Vector2d::Zero(), near, kPieceM);
  add_echoes(contour, car(), Vector2d::Zero(), far, kPieceM);
  ASSERT_EQ(contour.points.size(), 1U);
  EXPECT_TRUE(contour.points.front().in_box_m.isApprox(Vector2f(0.25F, 1.0F)));
}

TEST(BodyContour, FollowsABoxThatIsCorrected) {
  BodyContour contour;
  for (int i = 0; i < 100; ++i) add_echoes(contour, car(), {0.0, 0.3}, left_flank(), kPieceM);
  for (int i = 0; i < 100; ++i) add_echoes(contour, car(), {0.0, 0.0}, left_flank(), kPieceM);
  for (const Vector2f& at_m : in_box(contour)) {
    if (std::abs(at_m.x()) < 1.5F) EXPECT_NEAR(at_m.y(), 1.0F, 0.01F);
  }
}

TEST(BodyContour, KeepsItsPlaceWhereTheCentreIsCorrected) {
  BodyContour contour;
  add_echoes(contour, car(), Vector2d::Zero(), rear(), kPieceM);
  recentre(contour, {0.5, 0.0});  // the body is a metre longer, its rear where it was
  Footprint longer = car();
  longer.length.value_m = 5.0;
  add_echoes(contour, longer, {0.5, 0.0}, rear(), kPieceM);
  EXPECT_EQ(contour.points.size(), 4U);
  for (const Vector2f& at_m : in_box(contour)) EXPECT_NEAR(at_m.x(), -2.5F, 1e-4F);
}

TEST(BodyContour, LeavesOutWhatLiesOffTheBody) {
  BodyContour contour;
  const std::vector<Vector2d> points_m = {{2.0, 0.0}, {3.5, 0.0}, {0.0, -4.0}};
  add_echoes(contour, car(), Vector2d::Zero(), points_m, kPieceM);
  EXPECT_EQ(contour.points.size(), 1U);
}

TEST(BodyContour, HasItsFrontBehindWhereItIsTurnedAbout) {
  BodyContour contour;
  add_echoes(contour, car(), Vector2d::Zero(), rear(), kPieceM);
  turn_about(contour);
  add_echoes(contour, car(), Vector2d::Zero(), {}, kPieceM);
  ASSERT_EQ(contour.points.size(), 4U);
  for (const Vector2f& at_m : in_box(contour)) EXPECT_NEAR(at_m.x(), 2.0F, 1e-4F);
}

TEST(BodyContour, IsBoundedForTheLongestBody) {
  Footprint bus = car();
  bus.length.value_m = 30.0;
  bus.width.value_m = 5.0;
  std::vector<Vector2d> points_m;
  for (double x_m = -15.0; x_m < 15.0; x_m += 0.05) {
    points_m.emplace_back(x_m, 2.5);
    points_m.emplace_back(x_m, -2.5);
  }
  for (double y_m = -2.5; y_m < 2.5; y_m += 0.05) {
    points_m.emplace_back(15.0, y_m);
    points_m.emplace_back(-15.0, y_m);
  }
  BodyContour contour;
  add_echoes(contour, bus, Vector2d::Zero(), points_m, kPieceM);
  EXPECT_LE(contour.points.size(), kMostContourPoints);
  const std::size_t capacity = contour.points.capacity();
  for (int i = 0; i < 10; ++i) add_echoes(contour, bus, Vector2d::Zero(), points_m, kPieceM);
  EXPECT_EQ(contour.points.capacity(), capacity);
  std::vector<Vector2f> published_m;
  put_contour(contour, 0.0, Vector2d::Zero(), 64, published_m);
  EXPECT_EQ(published_m.size(), 64U);
}

}  // namespace
}  // namespace slammot::tracking
