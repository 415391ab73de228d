#include <algorithm>
#include <random>

#include <gtest/gtest.h>

#include "services/localization/localizer.hpp"
#include "tests/support/example_submap.hpp"
#include "tests/support/localizer_drive.hpp"

namespace slammot::localization {
namespace {

using slammot::testing::arc;
using slammot::testing::drive_one;
using slammot::testing::drive_through;
using slammot::testing::DriveSetup;
using slammot::testing::SimulatedDrive;

DriveSetup street_drive() {
  DriveSetup setup{.world = slammot::testing::street(80.0),
                   .world_from_base_at = arc({2.0, -1.0, 0.02}, 8.0, 0.0)};
  setup.scan_period_s = 0.05;
  setup.wheels = {.scale = 1.01};
  return setup;
}

LocalizerConfig config_of_many_submaps() {
  LocalizerConfig config = slammot::testing::small_map_config();
  config.map.side_m = 60.0;
  config.map.new_map_after_m = 15.0;
  return config;
}

std::vector<std::byte> checkpoint_after(std::uint32_t scans,
                                        const LocalizerConfig& config = config_of_many_submaps()) {
  SimulatedDrive drive(street_drive());
  Localizer localizer(config);
  drive_through(localizer, drive, 0, scans);
  return localizer.checkpoint();
}

/// Every bit that leaves the localizer.
void expect_same_future(Localizer& a, Localizer& b, std::uint32_t first, std::uint32_t last) {
  SimulatedDrive drive_a(street_drive());
  SimulatedDrive drive_b(street_drive());
  int submaps = 0;
  for (std::uint32_t scan = first; scan < last; ++scan) {
    const auto of_a = drive_one(a, drive_a, scan);
    const auto of_b = drive_one(b, drive_b, scan);
    ASSERT_EQ(of_a->odom_from_base.pose, of_b->odom_from_base.pose) << scan;
    ASSERT_EQ(of_a->odom_from_base.covariance, of_b->odom_from_base.covariance);
    ASSERT_EQ(of_a->map_from_odom, of_b->map_from_odom);
    ASSERT_EQ(of_a->submap_id, of_b->submap_id);
    for (std::size_t i = 0; i < of_a->beams.size(); ++i) {
      ASSERT_EQ(of_a->beams[i].expected_range_m, of_b->beams[i].expected_range_m);
      ASSERT_EQ(of_a->beams[i].free_evidence, of_b->beams[i].free_evidence);
      ASSERT_EQ(of_a->beams[i].end_cell, of_b->beams[i].end_cell);
    }
    const auto submap_of_a = a.take_finished_submap();
    const auto submap_of_b = b.take_finished_submap();
    ASSERT_EQ(submap_of_a.has_value(), submap_of_b.has_value());
    if (submap_of_a) ASSERT_TRUE(slammot::testing::same_submap(*submap_of_a, *submap_of_b));
    submaps += submap_of_a.has_value();
  }
  EXPECT_GT(submaps, 0);
  EXPECT_EQ(a.checkpoint(), b.checkpoint());
  EXPECT_EQ(a.counters().scans.localized, b.counters().scans.localized);
  EXPECT_EQ(a.calibration(), b.calibration());
}

TEST(Checkpoint, GoesOnAlongABareWallAsIfNothingHadHappened) {
  DriveSetup setup = street_drive();
  setup.world = {{{-300.0, 8.0}, {300.0, 8.0}}};
  SimulatedDrive drive(setup);
  Localizer original(slammot::testing::small_map_config());
  drive_through(original, drive, 0, 60);
  Localizer restored(slammot::testing::small_map_config());
  ASSERT_TRUE(restored.restore(original.checkpoint()));
  SimulatedDrive same_drive(setup);
  restored.add_odometry(same_drive.odometry(59));
  for (std::uint32_t scan = 60; scan < 80; ++scan) {
    const auto before = drive_one(original, drive, scan);
    const auto after = drive_one(restored, same_drive, scan);
    ASSERT_EQ(after->odom_from_base.pose, before->odom_from_base.pose);
    ASSERT_EQ(after->odom_from_base.covariance, before->odom_from_base.covariance);
  }
  EXPECT_EQ(restored.counters().matches.sampled, original.counters().matches.sampled);
  EXPECT_GT(original.counters().matches.sampled, 60U);
}

TEST(Checkpoint, IsBridgedByTheOdometryThatCameBeforeItWasTakenUp) {
  SimulatedDrive drive(street_drive());
  Localizer original(config_of_many_submaps());
  drive_through(original, drive, 0, 60);
  Localizer restored(config_of_many_submaps());
  restored.add_odometry(drive.odometry(120));  // three seconds and 24 m later
  ASSERT_TRUE(restored.restore(original.checkpoint()));
  const auto localized = restored.localize(drive.scan(120));
  ASSERT_TRUE(localized);
  EXPECT_LT(slammot::testing::distance_m(localized->odom_from_base.pose, drive.odom_from_base(120)),
            0.3);
  EXPECT_EQ(restored.counters().odometry.missing, original.counters().odometry.missing);
}

TEST(Checkpoint, LetsARestoredLocalizerGoOnBitByBit) {
  for (const std::uint32_t scans : {1U, 20U, 60U}) {
    SimulatedDrive drive(street_drive());
    Localizer original(config_of_many_submaps());
    drive_through(original, drive, 0, scans);
    original.correct({3, {1.0, 2.0, 0.5}, {}});
    while (original.take_finished_submap()) {}
    Localizer restored(config_of_many_submaps());
    ASSERT_TRUE(restored.restore(original.checkpoint()));
    expect_same_future(original, restored, scans, scans + 60);
  }
}

TEST(Checkpoint, OfTheLocalMapIsNotTroubledBySurfelsThatHadGone) {
  LocalMapConfig config;
  config.side_m = 20.0;
  const auto wall = [](double y_m) { return grids::Ray{{3.1, y_m}, grids::Echo::kStationary}; };
  std::vector<grids::Ray> through;
  for (double y_m = -1.0; y_m < 1.5; y_m += 0.05)
    through.push_back({{6.1, y_m}, grids::Echo::kNone});
  LocalMap original(config, {0.0, 0.0});
  original.integrate(1, {0.1, 0.1}, {wall(0.1), wall(2.1)}, 0.0);
  for (int i = 0; i < 29; ++i) original.integrate(2 + i, {0.1, 0.1}, through, 0.0);
  ASSERT_EQ(original.surfels().all().size(), 1U);
  std::vector<std::byte> bytes;
  original.snapshot().write(bytes);
  ByteReader from(bytes);
  auto restored = LocalMap::restored(config, from);
  ASSERT_TRUE(restored);
  for (LocalMap* map : {&original, &*restored}) map->integrate(50, {0.1, 0.1}, {wall(0.1)}, 0.0);
  EXPECT_EQ(original.surfels().all().size(), 2U);
  EXPECT_TRUE(slammot::testing::same_submap(original.submap(), restored->submap()));
}

TEST(Checkpoint, IsTheSameBytesForTheSameDrive) {
  EXPECT_EQ(checkpoint_after(25), checkpoint_after(25));
}

TEST(Checkpoint, OfASnapshotIsThatOfItsMomentThoughTheLocalizerGoesOnToOtherSubmaps) {
  SimulatedDrive drive(street_drive());
  Localizer localizer(config_of_many_submaps());
  drive_through(localizer, drive, 0, 25);
  const auto then = localizer.checkpoint();
  const auto snapshot = localizer.snapshot();
  drive_through(localizer, drive, 25, 90);
  ASSERT_TRUE(localizer.take_finished_submap());
  EXPECT_EQ(to_bytes(*snapshot), then);
  const auto now = localizer.snapshot(localizer.snapshot()->map);
  EXPECT_EQ(to_bytes(*now), localizer.checkpoint()) << "in the memory of another snapshot";
}

TEST(Checkpoint, OfARestoredLocalizerIsTheSameBytesAgain) {
  const auto bytes = checkpoint_after(25);
  Localizer restored(config_of_many_submaps());
  ASSERT_TRUE(restored.restore(bytes));
  EXPECT_EQ(restored.checkpoint(), bytes);
}

TEST(Checkpoint, ForgetsWhatTheRestoredOneHadBefore) {
  SimulatedDrive drive(street_drive());
  Localizer original(config_of_many_submaps());
  drive_through(original, drive, 0, 20);
  while (original.take_finished_submap()) {}
  Localizer restored(config_of_many_submaps());
  SimulatedDrive other(
      {.world = slammot::testing::room(), .world_from_base_at = arc({0.0, -3.0, 0.0}, 0.5, 0.2)});
  drive_through(restored, other, 0, 30);
  ASSERT_TRUE(restored.restore(original.checkpoint()));
  expect_same_future(original, restored, 20, 80);
}

/// A localizer in use that must not be touched by what it refuses.
class RefusedCheckpoint : public ::testing::Test {
 protected:
  RefusedCheckpoint() { drive_through(localizer_, drive_, 0, 10); }

  void expect_refused(std::span<const std::byte> bytes) {
    const auto before = localizer_.checkpoint();
    EXPECT_FALSE(localizer_.restore(bytes));
    EXPECT_EQ(localizer_.checkpoint(), before);
  }

  SimulatedDrive drive_{street_drive()};
  Localizer localizer_{config_of_many_submaps()};
};

TEST_F(RefusedCheckpoint, WhenEmpty) {
  expect_refused({});
  expect_refused(Localizer(config_of_many_submaps()).checkpoint());
}

TEST_F(RefusedCheckpoint, WhereverItIsCut) {
  const auto bytes = checkpoint_after(5);
  for (std::size_t size = 0; size < bytes.size(); size += size < 2000 ? 7 : 9973)
    expect_refused(std::span(bytes).first(size));
  expect_refused(std::span(bytes).first(bytes.size() - 1));
}

TEST_F(RefusedCheckpoint, WhenBytesFollow) {
  auto bytes = checkpoint_after(5);
  bytes.push_back(std::byte{0});
  expect_refused(bytes);
}

TEST_F(RefusedCheckpoint, WhicheverBitIsWrong) {
  auto bytes = checkpoint_after(5);
  std::mt19937 random(6);
  for (int i = 0; i < 60; ++i) {
    const std::size_t place = i < 30 ? random() % 600 : random() % bytes.size();
    const auto bit = std::byte{static_cast<unsigned char>(1U << random() % 8)};
    bytes[place] ^= bit;
    expect_refused(bytes);
    bytes[place] ^= bit;
  }
}

TEST_F(RefusedCheckpoint, WhenItIsNone) {
  std::mt19937 random(5);
  for (const std::size_t size : {1U, 100U, 100000U}) {
    std::vector<std::byte> bytes(size);
    for (std::byte& byte : bytes) byte = static_cast<std::byte>(random());
    expect_refused(bytes);
    std::fill(bytes.begin(), bytes.end(), std::byte{0});
    expect_refused(bytes);
  }
}

TEST_F(RefusedCheckpoint, WhenItsMapIsOfAnotherShape) {
  LocalizerConfig larger = config_of_many_submaps();
  larger.map.side_m = 80.0;
  expect_refused(checkpoint_after(5, larger));
  LocalizerConfig finer = config_of_many_submaps();
  finer.map.surfel_size_m = 0.1;
  expect_refused(checkpoint_after(5, finer));
}

}  // namespace
}  // namespace slammot::localization
