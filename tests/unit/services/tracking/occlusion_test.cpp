#include "services/tracking/occlusion.hpp"

#include <numbers>

#include <gtest/gtest.h>

#include "tests/support/example_tracks.hpp"
#include "tests/support/turned_scan.hpp"

namespace slammot::tracking {
namespace {

constexpr std::int64_t kSecondNs = 1'000'000'000;

/// Hidden for some time until now, when beams pass freely to 30 m; sigma of its position along x.
bool stays_hidden(Track track, double hidden_s, double sigma_m) {
  flow::SegmentedScan scan = testing::turned_scan(720, std::numbers::pi / 360);
  scan.odom_from_base = {};
  scan.stamp_ns = 100 * kSecondNs;
  for (float& range_m : scan.range_m) range_m = 30.0F;
  track.kinematics.estimate.covariance(0, 0) = sigma_m * sigma_m;
  track.history.misses = 20;
  track.history.is_hidden = true;
  track.history.last_seen_ns = scan.stamp_ns - static_cast<std::int64_t>(hidden_s * 1e9);
  follow_occlusion(track, ScanView(scan), {});
  return track.history.is_hidden;
}

TEST(FollowOcclusion, EndsForAVehicleWhosePlaceIsKnownOnceBeamsPass) {
  EXPECT_FALSE(stays_hidden(testing::followed_car(), 0.5, 0.5));
  EXPECT_FALSE(stays_hidden(testing::followed_car(), 2.5, 3.0));
}

TEST(FollowOcclusion, LastsForAVehicleWhosePlaceIsForgotten) {
  EXPECT_TRUE(stays_hidden(testing::followed_car(), 2.5, 5.0));
}

TEST(FollowOcclusion, LastsForAPedestrianAfterASecond) {
  Track walker = testing::followed_car();
  walker.extent.outline = Blob();
  walker.extent.footprint().length.value_m = walker.extent.footprint().width.value_m = 0.6;
  EXPECT_FALSE(stays_hidden(walker, 0.5, 0.3));
  EXPECT_TRUE(stays_hidden(walker, 2.5, 0.3));
}

}  // namespace
}  // namespace slammot::tracking
