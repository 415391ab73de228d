#include "services/localization/submap_measurements.hpp"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

namespace slammot::localization {
namespace {

using geometry::Pose2;

constexpr std::int64_t kSecond_ns = 1'000'000'000;

sensing::GnssFix fix_at(double stamp_s) {
  sensing::GnssFix fix;
  fix.stamp_ns = static_cast<std::int64_t>(stamp_s * 1e9);
  fix.quality = sensing::GnssQuality::single;
  fix.position = {40.0 + 1e-5 * stamp_s, -80.0};
  fix.covariance_m2 = 2.0 * geometry::Matrix2::Identity();
  return fix;
}

sensing::CompassReading reading_at(double stamp_s) {
  return {static_cast<std::int64_t>(stamp_s * 1e9), "main", 0.5, 0.05};
}

/// A vehicle at 10 m/s along x of odom with a scan each 0.1 s; the submap lies 5 m ahead of odom.
struct SubmapMeasurementsTest : ::testing::Test {
  void drive_until(double stamp_s) {
    for (; now_s <= stamp_s + 1e-9; now_s += 0.1)
      measurements.place(std::llround(now_s * 1e9), Pose2{10.0 * now_s, 0.0, 0.2});
  }
  flow::Submap submap() {
    flow::Submap ended;
    ended.odom_from_submap = {5.0, 0.0, 0.0};
    measurements.move_into(ended);
    return ended;
  }

  SubmapMeasurements measurements;
  double now_s = 0.0;
};

TEST_F(SubmapMeasurementsTest, PlacesAFixBetweenTheScansAroundIt) {
  measurements.add(fix_at(1.25));
  drive_until(2.0);
  const flow::Submap ended = submap();
  ASSERT_EQ(ended.fixes.size(), 1U);
  EXPECT_NEAR(ended.fixes[0].x_m, 12.5 - 5.0, 1e-4);
  EXPECT_EQ(ended.fixes[0].position.latitude_deg, fix_at(1.25).position.latitude_deg);
  EXPECT_EQ(ended.fixes[0].east_variance_m2, 2.0F);
  EXPECT_TRUE(submap().fixes.empty());
}

TEST_F(SubmapMeasurementsTest, PlacesAFixThatComesHalfASecondLate) {
  drive_until(2.0);
  measurements.add(fix_at(1.5));
  drive_until(2.1);
  ASSERT_EQ(submap().fixes.size(), 1U);
}

TEST_F(SubmapMeasurementsTest, PlacesAHeading) {
  measurements.add(reading_at(1.0));
  drive_until(1.5);
  const flow::Submap ended = submap();
  ASSERT_EQ(ended.headings.size(), 1U);
  EXPECT_NEAR(ended.headings[0].in_submap_rad, 0.2, 1e-6);
  EXPECT_NEAR(ended.headings[0].from_east_rad, 0.5, 1e-6);
}

TEST_F(SubmapMeasurementsTest, TakesNoneOfAStandingVehicleButOne) {
  for (int i = 0; i < 50; ++i) {
    measurements.add(fix_at(0.1 * i));
    measurements.place(i * kSecond_ns / 10, Pose2::identity());
  }
  EXPECT_EQ(submap().fixes.size(), 1U);
}

TEST_F(SubmapMeasurementsTest, KeepsNoMoreThanASubmapMayHold) {
  for (int i = 0; i < 2000; ++i) measurements.add(fix_at(0.3 * i));
  drive_until(600.0);
  EXPECT_LE(submap().fixes.size(), flow::kMostFixesOfSubmap);
}

TEST_F(SubmapMeasurementsTest, DropsWhatIsNoFixOrNotFinite) {
  sensing::GnssFix none = fix_at(0.5);
  none.quality = sensing::GnssQuality::no_fix;
  sensing::GnssFix broken = fix_at(0.6);
  broken.position.latitude_deg = std::numeric_limits<double>::quiet_NaN();
  measurements.add(none);
  measurements.add(broken);
  drive_until(1.0);
  EXPECT_TRUE(submap().fixes.empty());
}

TEST_F(SubmapMeasurementsTest, DropsWhatWasMeasuredWhileTheVehicleWasLost) {
  drive_until(1.0);
  measurements.add(fix_at(1.5));
  measurements.lose_place();
  now_s = 2.0;
  drive_until(3.0);
  EXPECT_TRUE(submap().fixes.empty());
}

}  // namespace
}  // namespace slammot::localization
