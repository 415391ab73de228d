#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "services/localization/localizer.hpp"
#include "tests/fuzz/saved_state.hpp"
#include "tests/support/localizer_drive.hpp"

namespace slammot::localization {
namespace {

using slammot::testing::arc;
using slammot::testing::drive_one;
using slammot::testing::drive_through;
using slammot::testing::put_strange_number;
using slammot::testing::sealed_again;
using slammot::testing::SimulatedDrive;

LocalizerConfig config() {
  LocalizerConfig config;
  config.map.side_m = 24.0;
  return config;
}

SimulatedDrive room_drive() {
  return SimulatedDrive(
      {.world = slammot::testing::room(), .world_from_base_at = arc({0.0, -3.0, 0.0}, 0.5, 0.2)});
}

std::vector<std::byte> example() {
  SimulatedDrive drive = room_drive();
  Localizer localizer(config());
  drive_through(localizer, drive, 0, 10);
  return localizer.checkpoint();
}

TEST(CheckpointFuzz, RefusesAnyBytes) {
  std::mt19937 random(1);
  Localizer localizer(config());
  for (int i = 0; i < 2000; ++i) {
    std::vector<std::byte> bytes(random() % 3000);
    for (std::byte& byte : bytes) byte = static_cast<std::byte>(random());
    ASSERT_FALSE(localizer.restore(bytes));
    if (bytes.size() >= sizeof(std::uint64_t)) ASSERT_FALSE(localizer.restore(sealed_again(bytes)));
  }
}

TEST(CheckpointFuzz, RefusesDamage) {
  std::mt19937 random(2);
  Localizer localizer(config());
  const auto bytes = example();
  for (int i = 0; i < 500; ++i) {
    auto damaged = bytes;
    put_strange_number(damaged, random() % (damaged.size() - 8), random);
    ASSERT_EQ(localizer.restore(damaged), damaged == bytes);
  }
}

TEST(CheckpointFuzz, GoesOnWithWhateverItAccepts) {
  std::mt19937 random(3);
  const auto bytes = example();
  int accepted = 0;
  SimulatedDrive drive = room_drive();
  drive.odometry(10);
  const auto scan = drive.scan(10);
  for (int i = 0; i < 400; ++i) {
    auto strange = bytes;
    // The state stands before the map, and the map's own numbers at its end.
    const std::size_t place = i % 4 == 0 ? strange.size() - 9 - random() % 4000 : random() % 600;
    put_strange_number(strange, place, random);
    Localizer localizer(config());
    if (!localizer.restore(sealed_again(strange))) continue;
    ++accepted;
    localizer.add_odometry(drive.odometry(10));
    if (const auto localized = localizer.localize(scan))
      localizer.integrate(slammot::testing::all_stationary(*localized));
    localizer.finish();
    while (localizer.take_finished_submap()) {}
    localizer.checkpoint();
  }
  EXPECT_GT(accepted, 20);
}

}  // namespace
}  // namespace slammot::localization
