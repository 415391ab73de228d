#include "services/localization/scan_points.hpp"

#include <cstddef>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace slammot::localization {
namespace {

using flow::PointLabel;
using ::testing::ElementsAre;

/// Three echoes ahead, one too near, one beyond the match range and none.
sensing::LaserScan scan() {
  sensing::LaserScan scan;
  scan.scanner.beam_step_rad = 0.01;
  scan.scanner.max_range_m = 100.0;
  scan.range_m = {5.0F, 6.0F, 7.0F, 0.1F, 90.0F, 100.0F};
  return scan;
}

ScanPoints selected(const std::vector<grids::Box>& masks = {},
                    const geometry::Pose2& odom_from_base = {}) {
  ScanPoints points{LocalizerConfig{}};
  points.begin_scan();
  points.deskew(scan(), 0.0, 0.0);
  points.select(scan(), odom_from_base, masks);
  return points;
}

TEST(ScanPoints, AreEchoesWithinTheMatchRange) {
  const ScanPoints points = selected();
  EXPECT_THAT(points.matched_beams(), ElementsAre(0U, 1U, 2U));
  EXPECT_EQ(points.all_in_base_m().size(), 6U);
  EXPECT_NEAR(points.matched()[1].in_base_m.norm(), 6.0, 1e-6);
}

TEST(ScanPoints, GrowLessExactWithTheRange) {
  const ScanPoints points = selected();
  EXPECT_GT(points.matched()[2].sigma_m, points.matched()[0].sigma_m);
}

TEST(ScanPoints, LeaveOutWhatIsMaskedWhereThePredictionHasIt) {
  const grids::Box mask{{16.0, 0.06}, {1.0, 0.0}, {0.2, 0.2}};
  EXPECT_THAT(selected({mask}, {10.0, 0.0, 0.0}).matched_beams(), ElementsAre(0U, 2U));
}

TEST(ScanPoints, LeaveOutWhatLabelsKeepOutOfTheSoMapUntilTheNextScan) {
  ScanPoints points = selected();
  const std::vector<PointLabel> labels = {PointLabel::kStationary, PointLabel::kMoving,
                                          PointLabel::kUnknown,    PointLabel::kMoving,
                                          PointLabel::kMoving,     PointLabel::kNoEcho};
  EXPECT_TRUE(points.leave_out(labels));
  points.select(scan(), {}, {});
  EXPECT_THAT(points.matched_beams(), ElementsAre(0U, 2U));
  EXPECT_FALSE(points.leave_out(labels)) << "they are left out already";
  points.begin_scan();
  points.select(scan(), {}, {});
  EXPECT_EQ(points.matched_beams().size(), 3U);
}

TEST(ScanPoints, LeaveOutWhatGoesAlongWithTheVehicle) {
  ScanPoints points = selected();
  points.begin_scan({1});
  points.select(scan(), {}, {});
  EXPECT_THAT(points.matched_beams(), ElementsAre(0U, 2U));
  EXPECT_EQ(points.all_in_base_m().size(), 6U);
}

TEST(ScanPoints, KeepThoseOfTheScanBefore) {
  ScanPoints points = selected();
  points.begin_scan();
  EXPECT_EQ(points.matched_before().size(), 3U);
}

/// Each body of so many echoes, across the view at its range, with a gap of five beams after it.
ScanPoints of_bodies(const std::vector<std::pair<std::size_t, float>>& bodies) {
  constexpr std::size_t kGap = 5;
  sensing::LaserScan scan;
  scan.scanner.beam_step_rad = 0.01;
  scan.scanner.first_beam_rad = -1.0;
  scan.scanner.max_range_m = 100.0;
  for (const auto& [echoes, range_m] : bodies) {
    scan.range_m.insert(scan.range_m.end(), echoes, range_m);
    scan.range_m.insert(scan.range_m.end(), kGap, 100.0F);
  }
  ScanPoints points{LocalizerConfig{}};
  points.begin_scan();
  points.deskew(scan, 0.0, 0.0);
  points.select(scan, {}, {});
  return points;
}

TEST(ScanPoints, OfOneBodyTellNothingOfTheVehicle) {
  EXPECT_EQ(of_bodies({{60, 3.0F}}).independent(), 0U);
  EXPECT_EQ(of_bodies({{60, 3.0F}}).evidence_share(), 0.0);
}

TEST(ScanPoints, OfTheLargestBodyCountNoMoreThanAllOthers) {
  EXPECT_EQ(of_bodies({{60, 3.0F}, {10, 6.0F}, {10, 8.0F}}).independent(), 40U);
  EXPECT_DOUBLE_EQ(of_bodies({{60, 3.0F}, {10, 6.0F}, {10, 8.0F}}).evidence_share(), 0.4);
}

TEST(ScanPoints, AllCountWhereNoBodyHasMost) {
  EXPECT_EQ(of_bodies({{40, 3.0F}, {30, 6.0F}, {10, 8.0F}}).independent(), 80U);
}

TEST(ScanPoints, OfALongWallAreOfSeveralBodies) {
  EXPECT_GT(of_bodies({{150, 12.0F}}).independent(), 100U);
}

}  // namespace
}  // namespace slammot::localization
