#include "services/localization/frozen_scanner.hpp"

#include <algorithm>
#include <optional>

#include <gtest/gtest.h>

#include "tests/support/mapped_world.hpp"

namespace slammot::localization {
namespace {

using geometry::Pose2;
using slammot::testing::MappedWorld;

class FrozenScannerTest : public ::testing::Test {
 protected:
  sensing::LaserScan scan_at(const Pose2& pose) const { return room_.scan_at(pose); }

  MappedWorld room_{slammot::testing::room()};
  FrozenScanner frozen_;
};

TEST_F(FrozenScannerTest, RepeatsItsReadingsWhileTheVehicleMoves) {
  const sensing::LaserScan scan = scan_at(Pose2::identity());
  EXPECT_FALSE(frozen_.repeats(scan, Pose2{}));
  EXPECT_FALSE(frozen_.repeats(scan, Pose2{0.02, 0.0, 0.0})) << "one that creeps";
  EXPECT_TRUE(frozen_.repeats(scan, Pose2{0.04, 0.0, 0.0})) << "since the readings came first";
  EXPECT_TRUE(frozen_.repeats(scan, Pose2{0.0, 0.0, 0.04}));
  EXPECT_FALSE(frozen_.repeats(scan_at({1.0, 0.0, 0.0}), Pose2{1.0, 0.0, 0.0}));
}

TEST_F(FrozenScannerTest, DoesNotWhereNothingTellsThatTheVehicleMoves) {
  const sensing::LaserScan scan = scan_at(Pose2::identity());
  for (int i = 0; i < 5; ++i) {
    EXPECT_FALSE(frozen_.repeats(scan, Pose2{})) << "it stands";
    EXPECT_FALSE(frozen_.repeats(scan, std::nullopt));
  }
}

TEST_F(FrozenScannerTest, DoesNotInTheOpenWhereNoBeamHasAnEcho) {
  sensing::LaserScan scan = scan_at(Pose2::identity());
  std::ranges::fill(scan.range_m, static_cast<float>(scan.scanner.max_range_m));
  EXPECT_FALSE(frozen_.repeats(scan, Pose2{}));
  EXPECT_FALSE(frozen_.repeats(scan, Pose2{5.0, 0.0, 0.0}));
}

TEST_F(FrozenScannerTest, IsJudgedByItsOwnReadings) {
  sensing::LaserScan front = scan_at(Pose2::identity());
  sensing::LaserScan rear = scan_at({0.5, 0.0, 0.0});
  rear.scanner.scanner_id = "rear";
  EXPECT_FALSE(frozen_.repeats(front, Pose2{}));
  EXPECT_FALSE(frozen_.repeats(rear, Pose2{}));
  EXPECT_TRUE(frozen_.repeats(front, Pose2{1.0, 0.0, 0.0}));
  EXPECT_FALSE(frozen_.repeats(scan_at({1.0, 0.0, 0.0}), Pose2{1.0, 0.0, 0.0}));
  EXPECT_TRUE(frozen_.repeats(rear, Pose2{1.0, 0.0, 0.0}));
}

}  // namespace
}  // namespace slammot::localization
