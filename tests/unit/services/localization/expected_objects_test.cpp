#include "services/localization/expected_objects.hpp"

#include <gtest/gtest.h>

namespace slammot::localization {
namespace {

using geometry::Vector2;

constexpr std::int64_t kSecond_ns = 1'000'000'000;

/// A car at 10 m ahead that drives off at 5 m/s, seen in scan 3 at 4 s.
flow::TrackedObjects a_car() {
  flow::TrackedObject car;
  car.confirmed = true;
  car.position_in_odom_m = {10.0, 0.0};
  car.velocity_in_odom_mps = {5.0, 0.0};
  car.length_m = 4.0;
  car.width_m = 2.0;
  car.first_seen_ns = kSecond_ns;
  car.last_seen_ns = 4 * kSecond_ns;
  flow::TrackedObjects objects;
  objects.stamp_ns = 4 * kSecond_ns;
  objects.sequence = 3;
  objects.objects = {car};
  return objects;
}

ExpectedObjects expecting(const flow::TrackedObjects& objects, const LocalizerConfig& config = {}) {
  ExpectedObjects expected(config);
  expected.expect(objects);
  return expected;
}

TEST(ExpectedObjects, AreMaskedWhereTheyWillBe) {
  ExpectedObjects expected = expecting(a_car());
  const auto& masks = expected.masks_at(4 * kSecond_ns + kSecond_ns / 2);
  ASSERT_EQ(masks.size(), 1U);
  EXPECT_TRUE(masks.front().covers({12.5, 0.0}));
  EXPECT_TRUE(masks.front().covers({14.8, 0.0})) << "within the margin";
  EXPECT_FALSE(masks.front().covers({10.0, 0.0}));
}

TEST(ExpectedObjects, AreNotMaskedWhileTentativeOrTooOldOrMapped) {
  flow::TrackedObjects tentative = a_car();
  tentative.objects.front().confirmed = false;
  EXPECT_TRUE(expecting(tentative).masks_at(4 * kSecond_ns).empty());
  EXPECT_TRUE(expecting(a_car()).masks_at(6 * kSecond_ns).empty());
  LocalizerConfig everything_stands;
  everything_stands.echoes.leave_out_moving = false;
  EXPECT_TRUE(expecting(a_car(), everything_stands).masks_at(4 * kSecond_ns).empty());
}

/// By how much the evidence of something at 10 m ahead falls when the labels of the scan come.
int taken_off(const flow::TrackedObjects& objects, std::uint32_t sequence) {
  LocalizerConfig config;
  config.map.side_m = 40.0;
  LocalMap map(config.map, Vector2::Zero());
  for (int i = 0; i < 5; ++i)
    map.integrate(i, {0.0, 0.0}, {{{10.05, 0.05}, grids::Echo::kStationary}}, 0.0);
  const auto steps = [&] {
    return map.evidence().so_steps(map.evidence().window().cell_at(10.05, 0.05));
  };
  const int before = steps();
  flow::ScanLabels labels;
  labels.stamp_ns = 4 * kSecond_ns;
  labels.sequence = sequence;
  expecting(objects, config).drive_over(labels, map);
  return before - steps();
}

TEST(ExpectedObjects, TakeOutOfTheMapWhatAMovingVehicleDrivesOver) {
  flow::TrackedObjects parked = a_car();
  parked.objects.front().velocity_in_odom_mps = {0.0, 0.0};
  EXPECT_EQ(taken_off(parked, 3), 0);
  EXPECT_GT(taken_off(a_car(), 3), 0);
}

TEST(ExpectedObjects, LeaveTheMapAloneWhereTheyAreOfAnotherScan) {
  EXPECT_EQ(taken_off(a_car(), 4), 0);
}

}  // namespace
}  // namespace slammot::localization
