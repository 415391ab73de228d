#include "common/traffic/submap_traffic.hpp"

#include <algorithm>

#include <gtest/gtest.h>

#include "tests/support/example_streams.hpp"
#include "tests/unit/common/traffic/tracked_car.hpp"

namespace slammot::traffic {
namespace {

using slammot::testing::example_streams;
using slammot::testing::same_stream;

std::vector<flow::Submap> submaps(std::initializer_list<std::uint32_t> ids) {
  std::vector<flow::Submap> made;
  for (const std::uint32_t id : ids) made.emplace_back().submap_id = {id};
  return made;
}

TEST(Renumbered, GivesEachSubmapItsNumberInTheOtherMap) {
  const SubmapTraffic traffic{{{3}, example_streams(3.0F)}, {{8}, example_streams(8.0F)}};
  const SubmapTraffic moved = renumbered(traffic, submaps({1, 3, 5, 8}), {20});
  ASSERT_EQ(moved.size(), 2U);
  EXPECT_TRUE(same_stream(moved.at({21}).front(), example_streams(3.0F).front()));
  EXPECT_TRUE(same_stream(moved.at({23}).front(), example_streams(8.0F).front()));
}

TEST(Renumbered, LeavesOutTrafficOfSubmapsThatTheMapLacks) {
  EXPECT_TRUE(renumbered({{{4}, example_streams()}}, submaps({1, 3}), {0}).empty());
}

TEST(TrafficOfDrive, HasWhatMovedInEachSubmap) {
  TrafficOfDrive drive;
  for (int scan = 0; scan <= 60; ++scan) {
    drive.take(car_at_scan(scan));
    if (scan == 20) drive.finish(submap_until(20, 0));
    if (scan == 30) drive.finish(submap_until(30, 1));
  }
  ASSERT_EQ(drive.by_submap().size(), 2U);
  const auto farthest_m = [&](std::uint32_t id) {
    float most = 0.0F;
    for (const FreeStream& stream : drive.by_submap().at({id}))
      most = std::max(most, stream.position_m.x());
    return most;
  };
  EXPECT_NEAR(farthest_m(0), 20.0F, 0.6F);
  EXPECT_NEAR(farthest_m(1), 30.0F, 0.6F);
}

TEST(TrafficOfDrive, LeavesOutSubmapsInWhichNothingMoved) {
  TrafficOfDrive drive;
  drive.finish(submap_until(20, 0));
  EXPECT_TRUE(drive.by_submap().empty());
}

}  // namespace
}  // namespace slammot::traffic
