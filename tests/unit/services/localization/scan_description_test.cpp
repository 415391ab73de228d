#include "services/localization/scan_description.hpp"

#include <algorithm>

#include <gtest/gtest.h>

#include "tests/support/mapped_world.hpp"
#include "tests/support/matchers.hpp"

namespace slammot::localization {
namespace {

using flow::EndCell;
using geometry::Pose2;
using slammot::testing::MappedWorld;
using slammot::testing::PoseNear;

/// A scan at the origin of a room in which the echo of one beam comes from half way to the wall.
class ScanDescriptionTest : public ::testing::Test {
 protected:
  static constexpr std::size_t kObstructed = 90;

  ScanDescriptionTest() {
    wall_m_ = scan_.range_m[kObstructed];
    scan_.range_m[kObstructed] *= 0.5F;
  }

  flow::LocalizedScan describe(LocalizerConfig config = MappedWorld::config_of_small_map()) {
    points_.deskew(scan_, 0.0, 0.0);
    ScanDescription description(config);
    return description.describe({.scan = scan_,
                                 .points = points_,
                                 .map = room_.map(),
                                 .odom_from_base = {Pose2::identity(), geometry::Matrix3::Zero()},
                                 .map_from_odom = {5.0, 0.0, 0.0},
                                 .sweep_s = 0.02},
                                {});
  }

  MappedWorld room_{slammot::testing::room()};
  sensing::LaserScan scan_ = room_.scan_at({});
  ScanPoints points_{room_.config()};
  float wall_m_ = 0.0F;
};

TEST_F(ScanDescriptionTest, TellsWhichEchoesTheMapContradictsAndHowFarItWouldHaveLetThemGo) {
  const flow::LocalizedScan localized = describe();
  EXPECT_EQ(localized.beams[kObstructed].end_cell, EndCell::kFree);
  EXPECT_NEAR(localized.beams[kObstructed].expected_range_m, wall_m_, 0.4);
  EXPECT_EQ(localized.beams[kObstructed + 90].end_cell, EndCell::kOccupied);
}

TEST_F(ScanDescriptionTest, AsksForTheRangesOfBeamsBesideSuchAnEchoOnlyUnlessAllAreWanted) {
  const auto asked = [](const flow::LocalizedScan& localized) {
    return std::ranges::count_if(localized.beams, [](const flow::LocalizedBeam& beam) {
      return beam.expected_range_m > 0.0F;
    });
  };
  EXPECT_EQ(asked(describe()), 2 * static_cast<std::ptrdiff_t>(flow::kExpectedAside) + 1);
  LocalizerConfig of_all = MappedWorld::config_of_small_map();
  of_all.echoes.expects_all_ranges = true;
  EXPECT_EQ(asked(describe(of_all)), static_cast<std::ptrdiff_t>(MappedWorld::kBeams));
}

TEST_F(ScanDescriptionTest, CarriesWhatItIsGiven) {
  const flow::LocalizedScan localized = describe();
  EXPECT_THAT(localized.map_from_odom, PoseNear(Pose2{5.0, 0.0, 0.0}, 1e-12));
  EXPECT_EQ(localized.sweep_s, 0.02);
  EXPECT_EQ(localized.submap_id, room_.map().submap_id());
}

}  // namespace
}  // namespace slammot::localization
