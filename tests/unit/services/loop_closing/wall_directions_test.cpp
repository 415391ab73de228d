#include "services/loop_closing/wall_directions.hpp"

#include <cmath>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

namespace slammot::loop_closing {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;

/// Walls of a rectangular room, turned by this angle; normals are exact.
std::vector<flow::Surfel> room_turned_by(double angle_rad) {
  constexpr int kSurfelsPerWall = 50;
  std::vector<flow::Surfel> surfels;
  for (int i = 0; i < kSurfelsPerWall; ++i) {
    for (const double wall_rad : {angle_rad, angle_rad + 0.5 * std::numbers::pi})
      surfels.push_back({0.0F, 0.0F, static_cast<float>(std::cos(wall_rad)),
                         static_cast<float>(std::sin(wall_rad)), 1.0F});
  }
  return surfels;
}

/// Headings of a room seen again, whose own walls are at source_rad and which lies turned by
/// turn_rad in the target.
class SameRoom {
 public:
  SameRoom(double source_rad, double turn_rad)
      : headings_(WallDirections(room_turned_by(source_rad + turn_rad)),
                  WallDirections(room_turned_by(source_rad))),
        turn_rad_(turn_rad) {}

  bool fits_when_off_by(double error_rad) const {
    return headings_.contains(turn_rad_ + error_rad);
  }

 private:
  PlausibleHeadings headings_;
  double turn_rad_;
};

TEST(PlausibleHeadings, IncludeAllWithinADegreeOfTheTruth) {
  for (int i = 0; i < 100; ++i) {
    const SameRoom room(0.37 * i * kDegree, 1.73 * i * kDegree);
    for (const double error_rad : {-1.0 * kDegree, 0.0, 1.0 * kDegree})
      EXPECT_TRUE(room.fits_when_off_by(error_rad)) << i << " off by " << error_rad;
  }
}

TEST(PlausibleHeadings, ExcludeThoseAtWhichWallsOfARoomCross) {
  const SameRoom room(0.0, 30.0 * kDegree);
  for (int degrees = 8; degrees <= 82; ++degrees)
    EXPECT_FALSE(room.fits_when_off_by(degrees * kDegree)) << degrees;
  EXPECT_TRUE(room.fits_when_off_by(90.0 * kDegree)) << "a rectangle looks the same";
}

TEST(PlausibleHeadings, AreAllWhereFewSurfelsHaveANormal) {
  std::vector<flow::Surfel> hedge = room_turned_by(0.0);
  for (std::size_t i = 0; i < hedge.size(); ++i)
    if (i % 3 != 0) hedge[i].normal_x = hedge[i].normal_y = 0.0F;
  const PlausibleHeadings headings{WallDirections(room_turned_by(0.0)), WallDirections(hedge)};
  EXPECT_FALSE(WallDirections(hedge).has_walls());
  EXPECT_TRUE(headings.contains(0.5 * 90.0 * kDegree));
}

}  // namespace
}  // namespace slammot::loop_closing
