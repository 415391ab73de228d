#include "services/localization/blind_scan.hpp"

#include <algorithm>

#include <gtest/gtest.h>

#include "tests/support/mapped_world.hpp"

namespace slammot::localization {
namespace {

using geometry::Pose2;
using slammot::testing::MappedWorld;

/// A scan at the origin of which so many beams have their echo, the others none.
sensing::LaserScan scan_with(std::size_t echoes, const MappedWorld& world) {
  sensing::LaserScan scan = world.scan_at(Pose2::identity());
  std::fill(scan.range_m.begin() + static_cast<std::ptrdiff_t>(echoes), scan.range_m.end(),
            static_cast<float>(scan.scanner.max_range_m));
  return scan;
}

TEST(BlindScan, HasHardlyAnEchoWhereTheMapExpectsMany) {
  const MappedWorld room(slammot::testing::room());
  for (const std::size_t echoes : {0U, 3U, 9U})
    EXPECT_TRUE(is_blind(scan_with(echoes, room), Pose2::identity(), room.map())) << echoes;
}

TEST(BlindScan, IsNoScanThatCanBeMatched) {
  const MappedWorld room(slammot::testing::room());
  for (const std::size_t echoes : {10U, 360U})
    EXPECT_FALSE(is_blind(scan_with(echoes, room), Pose2::identity(), room.map())) << echoes;
}

TEST(BlindScan, IsNoScanWhereNothingIsExpected) {
  const MappedWorld room(slammot::testing::room());
  const LocalMap empty(MappedWorld::config_of_small_map().map, geometry::Vector2::Zero());
  EXPECT_FALSE(is_blind(scan_with(0, room), Pose2::identity(), empty));
}

}  // namespace
}  // namespace slammot::localization
