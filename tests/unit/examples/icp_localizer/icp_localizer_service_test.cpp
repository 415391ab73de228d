#include "examples/icp_localizer/icp_localizer_service.hpp"

#include <cmath>
#include <numbers>
#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/config/overlay.hpp"
#include "common/wire/sensor.hpp"
#include "common/wire/service.hpp"
#include "tests/support/service_on_the_bus.hpp"

namespace slammot::icp_localizer {
namespace {

using slammot::testing::kForever;
using ::testing::ElementsAre;

std::int64_t stamp_ns_of(std::uint32_t sequence) {
  return 100'000'000'000 + std::int64_t{sequence} * 100'000'000;
}

/// Of a vehicle that stands in the middle of a room of 10 m by 10 m.
sensing::LaserScan room_scan(std::uint32_t sequence) {
  sensing::LaserScan scan;
  scan.stamp_ns = stamp_ns_of(sequence);
  scan.sequence = sequence;
  scan.scanner.first_beam_rad = -std::numbers::pi / 2.0;
  scan.scanner.beam_step_rad = std::numbers::pi / 180.0;
  scan.scanner.max_range_m = 30.0;
  for (std::size_t beam = 0; beam < 181; ++beam) {
    const double angle_rad = sensing::beam_angle_rad(scan.scanner, beam);
    scan.range_m.push_back(static_cast<float>(
        5.0 / std::max(std::abs(std::cos(angle_rad)), std::abs(std::sin(angle_rad)))));
  }
  return scan;
}

struct IcpLocalizerOnTheBus : slammot::testing::ServiceOnTheBus {
  dds::Writer<slammot_LaserScan> scans{neighbour_, dds::topics::kLaserScan};
  dds::Writer<slammot_Odometry> odometry{neighbour_, dds::topics::kOdometry};
  dds::Writer<slammot_Command> commands{neighbour_, dds::topics::kCommand};
  dds::Reader<slammot_LocalizedScan> localized{neighbour_, dds::topics::kLocalizedScan};
  dds::Reader<slammot_SubmapTile> tiles{neighbour_, dds::topics::kSubmapTile};
  std::uint64_t drive_id = 1;
  std::vector<std::uint32_t> sequences;
  std::set<std::uint64_t> maps;
  std::set<std::uint32_t> submaps;

  void begin() {
    start<IcpLocalizerService>("localization");
    ASSERT_TRUE(scans.wait_for_readers(1, kForever));
    ASSERT_TRUE(odometry.wait_for_readers(1, kForever));
    ASSERT_TRUE(commands.wait_for_readers(1, kForever));
    ASSERT_TRUE(localized.wait_for_writers(1, kForever));
    ASSERT_TRUE(tiles.wait_for_writers(1, kForever));
  }
  void localize(std::uint32_t sequence, bool with_odometry = true) {
    const std::size_t so_far = sequences.size();
    if (with_odometry)
      odometry.write(wire::encode("car", sensing::Odometry{stamp_ns_of(sequence), {}}));
    scans.write(wire::LaserScanEncoder(drive_id).encode("car", room_scan(sequence)));
    ASSERT_TRUE(comes_to([&] {
      localized.take_each([this](const slammot_LocalizedScan& scan) {
        sequences.push_back(scan.sequence_number);
        maps.insert(scan.map_id);
      });
      return sequences.size() > so_far;
    }));
  }
};

TEST_F(IcpLocalizerOnTheBus, LocalizesEveryScanWithAndWithoutOdometry) {
  begin();
  for (const std::uint32_t sequence : {0U, 1U, 2U}) localize(sequence, sequence != 2);
  EXPECT_THAT(sequences, ElementsAre(0, 1, 2));
  EXPECT_EQ(maps.size(), 1U);
}

TEST_F(IcpLocalizerOnTheBus, RepeatsTheLatestAnswerToARepeatedScan) {
  begin();
  for (const std::uint32_t sequence : {0U, 1U, 1U, 0U}) localize(sequence);
  EXPECT_THAT(sequences, ElementsAre(0, 1, 1, 1));
}

TEST_F(IcpLocalizerOnTheBus, BeginsAMapWithEachDrive) {
  begin();
  for (const std::uint32_t sequence : {5U, 6U}) localize(sequence);
  drive_id = 2;
  localize(0);
  EXPECT_THAT(sequences, ElementsAre(5, 6, 0));
  EXPECT_EQ(maps.size(), 2U);
}

TEST_F(IcpLocalizerOnTheBus, PublishesItsSubmapOnCommand) {
  begin();
  for (std::uint32_t sequence = 0; sequence < 10; ++sequence) localize(sequence);
  wire::Command command;
  command.vehicle_id = "car";
  command.service = "localization";
  command.requester = "test";
  command.request_number = 1;
  command.verb = "finish_submap";
  commands.write(wire::encode(command));
  EXPECT_TRUE(comes_to([this] {
    tiles.take_each([this](const slammot_SubmapTile& tile) { submaps.insert(tile.submap_id); });
    return !submaps.empty();
  }));
  EXPECT_THAT(submaps, ElementsAre(0));
}

TEST(IcpLocalizerSettings, AreASubsetOfThoseOfTheStageThatItReplaces) {
  IcpLocalizerService::Settings settings;
  const auto fault = config::overlay_text(
      "localization { match_range_m: 30 map { cell_size_m: 0.05 surfel_size_m: 0.1 } }", "profile",
      IcpLocalizerService::stages(settings));
  ASSERT_FALSE(fault) << fault->text();
  EXPECT_EQ(settings.config.match_range_m, 30.0);
  EXPECT_EQ(settings.config.cell_size_m, 0.05);
  EXPECT_EQ(settings.config.surfel_size_m, 0.1);
}

}  // namespace
}  // namespace slammot::icp_localizer
