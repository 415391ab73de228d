#include "services/localization/localization_service.hpp"

#include <cmath>
#include <numbers>
#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/wire/graph.hpp"
#include "common/wire/sensor.hpp"
#include "common/wire/service.hpp"
#include "common/wire/stored_map.hpp"
#include "tests/support/service_on_the_bus.hpp"

namespace slammot::localization {
namespace {

using slammot::testing::kForever;

constexpr std::int64_t kPeriodNs = 100'000'000;

std::int64_t stamp_ns_of(std::uint32_t sequence) {
  return 100'000'000'000 + std::int64_t{sequence} * kPeriodNs;
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

/// Of one that stands among posts, all of them where the room is empty.
sensing::LaserScan scan_among_posts(std::uint32_t sequence) {
  sensing::LaserScan scan = room_scan(sequence);
  for (std::size_t beam = 0; beam < scan.range_m.size(); ++beam)
    scan.range_m[beam] = 1.0F + 0.25F * static_cast<float>((beam / 6 * 7) % 13);
  return scan;
}

struct LocalizationOnTheBus : slammot::testing::ServiceOnTheBus {
  /// Of a source; another one has nothing of the scans before it.
  std::optional<dds::Writer<slammot_LaserScan>> scans;
  std::optional<dds::Writer<slammot_Odometry>> odometry;
  dds::Reader<slammot_LocalizedScan> localized{neighbour_, dds::topics::kLocalizedScan,
                                               dds::History::kRecorder};
  std::uint64_t drive_id = 1;
  std::vector<std::uint32_t> sequences;
  std::set<std::uint64_t> maps;
  std::set<std::uint64_t> odoms;
  flow::SubmapId submap_in_use;
  geometry::Pose2 map_from_odom;

  LocalizationOnTheBus() { restart_source(); }
  void restart_source() {
    scans.emplace(neighbour_, dds::topics::kLaserScan);
    odometry.emplace(neighbour_, dds::topics::kOdometry);
  }
  void begin(const LocalizationService::Settings& settings = {}) {
    start<LocalizationService>("localization", settings);
    ASSERT_TRUE(scans->wait_for_readers(1, kForever));
    ASSERT_TRUE(odometry->wait_for_readers(1, kForever));
    ASSERT_TRUE(localized.wait_for_writers(1, kForever));
  }
  void send(std::uint32_t sequence) {
    odometry->write(wire::encode("car", sensing::Odometry{stamp_ns_of(sequence), {}}));
    scans->write(wire::LaserScanEncoder(drive_id).encode("car", room_scan(sequence)));
  }
  app::ServiceState state() { return context_->status().state(std::chrono::steady_clock::now()); }
  std::string explanation() {
    return context_->status().explanation(std::chrono::steady_clock::now());
  }
  bool has_localized(std::size_t count) {
    localized.take_each([this](const slammot_LocalizedScan& scan) {
      sequences.push_back(scan.sequence_number);
      maps.insert(scan.map_id);
      submap_in_use = {scan.submap_id};
      map_from_odom = {scan.map_from_odom.x_m, scan.map_from_odom.y_m,
                       scan.map_from_odom.heading_rad};
      odoms.insert(scan.odom_id);
    });
    return sequences.size() >= count;
  }
  void localize(std::uint32_t first, std::uint32_t end) {
    for (std::uint32_t sequence = first; sequence < end; ++sequence) {
      const std::size_t so_far = sequences.size();
      send(sequence);
      ASSERT_TRUE(comes_to([&] { return has_localized(so_far + 1); }));
    }
  }
  std::uint64_t count(const std::string& name) { return context_->status().counter(name); }
};

TEST_F(LocalizationOnTheBus, LocalizesEveryScan) {
  begin();
  localize(0, 3);
  EXPECT_THAT(sequences, ::testing::ElementsAre(0, 1, 2));
}

TEST_F(LocalizationOnTheBus, AnswersAScanThatIsDoneWithTheNewestOne) {
  begin();
  localize(0, 3);
  send(2);
  ASSERT_TRUE(comes_to([this] { return has_localized(4); }));
  send(0);
  ASSERT_TRUE(comes_to([this] { return has_localized(5); }));
  EXPECT_THAT(sequences, ::testing::ElementsAre(0, 1, 2, 2, 2));
}

TEST_F(LocalizationOnTheBus, CountsBadInputInItsStatusAndGoesOn) {
  begin();
  dds::Reader<slammot_ServiceStatus> statuses(neighbour_, dds::topics::kStatus);
  localize(0, 10);
  for (const std::uint32_t stale : {9U, 9U, 4U, 3U}) {  // a repeated stamp, and scans out of order,
                                                        // two in a row each
    send(stale);
    ASSERT_TRUE(comes_to([&, so_far = sequences.size()] { return has_localized(so_far + 1); }));
  }
  const auto send_blind = [this](std::uint32_t sequence, std::size_t valid_beams) {
    const std::size_t so_far = sequences.size();
    sensing::LaserScan scan = room_scan(sequence);
    for (std::size_t beam = valid_beams; beam < scan.range_m.size(); ++beam)
      scan.range_m[beam] = static_cast<float>(scan.scanner.max_range_m);
    odometry->write(wire::encode("car", sensing::Odometry{scan.stamp_ns, {}}));
    scans->write(wire::LaserScanEncoder(drive_id).encode("car", scan));
    ASSERT_TRUE(comes_to([&] { return has_localized(so_far + 1); }));
  };
  send_blind(10, 3);
  send_blind(11, 0);
  localize(40, 41);  // after 2.9 s
  odometry->write(wire::encode("car", sensing::Odometry{stamp_ns_of(41), {400.0, 0.0, 0.0}}));
  scans->write(wire::LaserScanEncoder(drive_id).encode("car", room_scan(41)));
  ASSERT_TRUE(comes_to([&, so_far = sequences.size()] { return has_localized(so_far + 1); }));
  const std::map<std::string, std::uint64_t> expected = {{"duplicate_scans", 2},
                                                         {"out_of_order_scans", 2},
                                                         {"blank_scans", 2},
                                                         {"gaps", 1},
                                                         {"odometry_jumps", 1}};
  std::map<std::string, std::uint64_t> counted;
  EXPECT_TRUE(comes_to([&] {
    statuses.take_each([&](const slammot_ServiceStatus& sample) {
      const auto status = wire::decode(sample);
      if (!status || status->name.service != "localization") return;
      for (const wire::Counter& counter : status->counters) {
        if (expected.contains(counter.name)) counted[counter.name] = counter.total;
      }
    });
    return counted == expected;
  })) << ::testing::PrintToString(counted);
  EXPECT_EQ(maps.size(), 1U);
}

TEST_F(LocalizationOnTheBus, DoesWithoutOdometry) {
  begin();
  scans->write(wire::LaserScanEncoder().encode("car", room_scan(0)));
  EXPECT_TRUE(comes_to([this] { return has_localized(1); }));
}

TEST_F(LocalizationOnTheBus, ComesBackFromItsCheckpointInTheSameDrive) {
  begin();
  localize(0, 25);  // 2.5 s
  stop();
  begin();
  localize(26, 27);
  EXPECT_EQ(count("restored_checkpoints"), 1U);
}

TEST_F(LocalizationOnTheBus, WorksThroughTheScansThatCameWhileItWasAway) {
  begin();
  localize(0, 25);
  stop();
  sequences.clear();
  for (std::uint32_t sequence = 25; sequence < 30; ++sequence) send(sequence);
  begin();
  ASSERT_TRUE(comes_to([this] { return has_localized(1) && sequences.back() == 29; }));
  EXPECT_THAT(sequences, ::testing::IsSupersetOf({25U, 26U, 27U, 28U, 29U}));
  EXPECT_EQ(maps.size(), 1U);
}

TEST_F(LocalizationOnTheBus, LeavesACheckpointOfTheNewestScanWhenItIsStopped) {
  begin();
  localize(0, 25);
  stop();
  sequences.clear();
  begin();
  send(25);
  ASSERT_TRUE(comes_to([this] { return has_localized(1) && sequences.back() == 25; }));
  EXPECT_EQ(count("restored_checkpoints"), 1U);
  EXPECT_THAT(sequences, ::testing::Each(::testing::Ge(24U)));
}

TEST_F(LocalizationOnTheBus, ComesBackHoweverLongItWasAway) {
  begin();
  localize(0, 25);
  stop();
  begin();
  localize(10'000, 10'001);
  EXPECT_EQ(count("restored_checkpoints"), 1U);
  EXPECT_EQ(maps.size(), 1U);
}

TEST_F(LocalizationOnTheBus, TellsASourceThatBeginsItsDriveAgainHowFarItIsAlsoAfterItsOwnCrash) {
  begin();
  localize(0, 25);
  stop();
  restart_source();
  begin();
  localize(0, 1);
  EXPECT_EQ(count("restored_checkpoints"), 1U);
  EXPECT_GT(sequences.back(), 0U);
}

TEST_F(LocalizationOnTheBus, BeginsANewMapAfterACrashInAnotherDrive) {
  begin();
  localize(0, 25);
  stop();
  restart_source();
  begin();
  drive_id = 2;
  localize(0, 1);
  EXPECT_EQ(count("restored_checkpoints"), 0U);
  EXPECT_EQ(maps.size(), 2U);
}

TEST_F(LocalizationOnTheBus, BeginsANewMapWhenTheSameLogIsPlayedAgain) {
  begin();
  localize(0, 5);
  drive_id = 2;
  localize(0, 5);
  EXPECT_THAT(sequences, ::testing::ElementsAre(0, 1, 2, 3, 4, 0, 1, 2, 3, 4));
  EXPECT_EQ(maps.size(), 2U);
  EXPECT_EQ(context_->status().counter("scans_of_earlier_drives"), 0U);
}

TEST_F(LocalizationOnTheBus, KeepsToItsDriveThroughAStrayScanOfAnother) {
  begin();
  localize(0, 10);
  drive_id = 99;
  send(3);
  drive_id = 1;
  localize(10, 30);
  EXPECT_TRUE(comes_to([this] { return count("stray_scans") == 1; }));
  EXPECT_THAT(explanation(), ::testing::HasSubstr("dropped scans of drive 99 of scanner front"));
  localize(30, 40);
  EXPECT_EQ(maps.size(), 1U);
  EXPECT_EQ(sequences.size(), 40U);
}

TEST_F(LocalizationOnTheBus, ReturnsToItsMapAfterAStrayScanWhileItsSourceWasSilent) {
  begin();
  localize(0, 25);
  drive_id = 99;
  localize(3, 4);  // nobody else sends: a drive of its own
  drive_id = 1;
  localize(26, 30);
  EXPECT_EQ(maps.size(), 2U);
  EXPECT_EQ(count("restored_checkpoints"), 1U);
}

/// Scans that fit the map, do not fit it, and fit it again, to a service that trusts no wheels.
struct LostOnTheBus : LocalizationOnTheBus {
  std::uint32_t next = 0;

  void SetUp() override {
    LocalizationService::Settings settings;
    settings.config.recovery.lost_after_s = 0.0;
    settings.config.odometry.may_be_picked_up = true;
    begin(settings);
  }
  void localize_next(sensing::LaserScan (*scan_of)(std::uint32_t)) {
    odometry->write(wire::encode("car", sensing::Odometry{stamp_ns_of(next), {}}));
    scans->write(wire::LaserScanEncoder(drive_id).encode("car", scan_of(next)));
    ++next;
    ASSERT_TRUE(comes_to([&, so_far = sequences.size()] { return has_localized(so_far + 1); }));
  }
  bool says_it_is_lost() {
    return explanation().find("looks for itself in the local map") != std::string::npos;
  }
};

TEST_F(LostOnTheBus, SaysThatItIsDegradedWhileScansDoNotFitAndNoLonger) {
  for (int i = 0; i < 20; ++i) localize_next(room_scan);
  EXPECT_FALSE(says_it_is_lost());
  for (int i = 0; i < 15 && !says_it_is_lost(); ++i) localize_next(scan_among_posts);
  EXPECT_TRUE(says_it_is_lost()) << explanation();
  EXPECT_EQ(state(), app::ServiceState::kDegraded);
  for (int i = 0; i < 10 && says_it_is_lost(); ++i) localize_next(room_scan);
  EXPECT_FALSE(says_it_is_lost()) << explanation();
  EXPECT_EQ(submap_in_use, flow::SubmapId{0});
  EXPECT_EQ(maps.size(), 1U);
}

TEST_F(LostOnTheBus, BeginsASubmapTiedToNothingWhereItDoesNotFindItself) {
  for (int i = 0; i < 20; ++i) localize_next(room_scan);
  const double patience_s = LocalizationMonitor::kAstrayAfterS;
  int scans_until_astray = 0;
  for (; submap_in_use == flow::SubmapId{0} && scans_until_astray < 60; ++scans_until_astray)
    localize_next(scan_among_posts);
  EXPECT_NEAR(scans_until_astray, patience_s / (kPeriodNs * 1e-9), 3.0);
  EXPECT_EQ(submap_in_use, flow::SubmapId{1});
  EXPECT_EQ(maps.size(), 1U);
  for (int i = 0; i < 10; ++i) localize_next(scan_among_posts);
  EXPECT_FALSE(says_it_is_lost()) << "the new submap is of this place";
  EXPECT_TRUE(comes_to([this] { return count("astray") > 0; }));
}

struct SubmapsOnTheBus : LocalizationOnTheBus {
  dds::Reader<slammot_SubmapTile> tiles{neighbour_, dds::topics::kSubmapTile};
  dds::Writer<slammot_Command> commands{neighbour_, dds::topics::kCommand};
  dds::Writer<slammot_StoredMap> stored_map{neighbour_, dds::topics::kStoredMap};

  void finish_submap() {
    ASSERT_TRUE(commands.wait_for_readers(1, kForever));
    slammot_Command command{};
    slammot::testing::assign(command.vehicle_id, "car");
    slammot::testing::assign(command.service_name, "localization");
    slammot::testing::assign(command.verb, "finish_submap");
    commands.write(command);
    ASSERT_TRUE(comes_to([this] { return tiles.take_each([](const auto&) {}) > 0; }));
  }
  bool has_a_tile_ended() {
    const dds::Loan<slammot_SubmapTile> loan = tiles.take();
    for (std::size_t i = 0; i < loan.size(); ++i) {
      if (!loan.info(i).has_value) return true;
    }
    return false;
  }
};

TEST_F(SubmapsOnTheBus, PublishesTheOneInUseWhenToldToFinishIt) {
  begin();
  localize(0, 5);
  finish_submap();
}

TEST_F(SubmapsOnTheBus, EndsTheTilesOfWhatMapStoreHas) {
  begin();
  localize(0, 5);
  finish_submap();
  const auto stored = [&](std::uint32_t submaps, std::uint32_t last_id) {
    const flow::StoredMap map{{*maps.begin()}, submaps, 0, {last_id}, 0.2};
    stored_map.write(wire::encode("car", map));
  };
  stored(1, 0);
  EXPECT_TRUE(comes_to([this] { return has_a_tile_ended(); }));
}

/// With a neighbour that stands for map_store and loop_closing.
struct LocalizationInAStoredMap : LocalizationOnTheBus {
  static constexpr flow::MapId kMap{7};
  dds::Writer<slammot_StoredMap> stored_map{neighbour_, dds::topics::kStoredMap};
  dds::Writer<slammot_GraphCorrection> corrections{neighbour_, dds::topics::kGraphCorrection};
  dds::Reader<slammot_SubmapTile> tiles{neighbour_, dds::topics::kSubmapTile};
  std::set<std::uint32_t> submaps_published;

  static LocalizationService::Settings continuing(double patience_s = 60.0) {
    return {.config = {}, .continues_map = true, .map_patience_s = patience_s};
  }
  void store(std::uint32_t submaps) {
    const flow::SubmapId last{submaps == 0 ? 0 : submaps - 1};
    stored_map.write(wire::encode(
        "car", flow::StoredMap{kMap, submaps, 0, last, LocalizerConfig().map.cell_size_m}));
  }
  /// Submap n lies at (10 n, 0).
  void place(std::uint32_t submaps, bool is_untied = false,
             const geometry::Pose2& map_from_odom_now = {}) {
    flow::GraphCorrection correction{submaps, map_from_odom_now, {}, kMap, is_untied};
    for (std::uint32_t id = 0; id < submaps; ++id)
      correction.submaps.push_back({{id}, {10.0 * id, 0.0, 0.0}});
    wire::GraphCorrectionEncoder().encode(
        "car", correction,
        [this](const slammot_GraphCorrection& part) { corrections.write(part); });
  }
  bool has_published(std::uint32_t submap) {
    tiles.take_each(
        [this](const slammot_SubmapTile& tile) { submaps_published.insert(tile.submap_id); });
    return submaps_published.contains(submap);
  }
};

TEST_F(LocalizationInAStoredMap, GoesOnAfterItsLastSubmap) {
  store(3);
  place(3);
  begin(continuing());
  localize(0, 1);
  EXPECT_THAT(maps, ::testing::ElementsAre(kMap.value));
  EXPECT_EQ(submap_in_use, flow::SubmapId{3});
  EXPECT_EQ(count("continued_maps"), 1U);
}

TEST_F(LocalizationInAStoredMap, HasItsFirstScansWaitUntilLoopClosingHasPlacedAllOfIt) {
  store(3);
  place(2);
  begin(continuing());
  ASSERT_TRUE(comes_to([this] { return explanation().find("2 of 3") != std::string::npos; }));
  EXPECT_EQ(state(), app::ServiceState::kStarting) << "sources of scans wait for what is starting";
  send(0);
  place(3);
  ASSERT_TRUE(comes_to([this] { return has_localized(1); }));
  EXPECT_EQ(submap_in_use, flow::SubmapId{3});
  EXPECT_NE(state(), app::ServiceState::kStarting);
}

TEST_F(LocalizationInAStoredMap, SaysThatItDoesNotKnowWhereItIsUntilASubmapOfItsOwnIsTied) {
  store(3);
  place(3);
  begin(continuing());
  localize(0, 1);
  EXPECT_THAT(explanation(), ::testing::HasSubstr("not found in the map"));
  place(4, true, {1.0, 0.0, 0.0});
  ASSERT_TRUE(comes_to([this] {
    localize(sequences.back() + 1, sequences.back() + 2);
    return map_from_odom.x_m == 1.0;
  }));
  EXPECT_THAT(explanation(), ::testing::HasSubstr("not found in the map"));
  place(5, false, {2.0, 0.0, 0.0});
  ASSERT_TRUE(comes_to([this] {
    localize(sequences.back() + 1, sequences.back() + 2);
    return map_from_odom.x_m == 2.0;
  }));
  EXPECT_THAT(explanation(), ::testing::Not(::testing::HasSubstr("not found in the map")));
}

TEST_F(LocalizationInAStoredMap, BeginsAMapOfItsOwnWhereNobodyStoresAny) {
  begin(continuing(0.2));
  localize(0, 1);
  EXPECT_EQ(submap_in_use, flow::SubmapId{0});
  EXPECT_EQ(count("begun_without_stored_map"), 1U);
  EXPECT_THAT(
      explanation(),
      ::testing::HasSubstr("cannot go on in the stored map: map_store has not said what it has"));
}

TEST_F(LocalizationInAStoredMap, BeginsAMapOfItsOwnWhereLoopClosingIsNotThere) {
  store(3);
  begin(continuing(0.2));
  localize(0, 1);
  EXPECT_THAT(maps, ::testing::Not(::testing::Contains(kMap.value)));
  EXPECT_EQ(count("begun_without_stored_map"), 1U);
  EXPECT_THAT(explanation(), ::testing::HasSubstr("loop closing has placed 0 of 3 submaps"));
}

TEST_F(LocalizationInAStoredMap, BeginsTheFirstMapOfAllWhereNothingIsStored) {
  store(0);
  begin(continuing());
  localize(0, 1);
  EXPECT_EQ(count("maps"), 1U);
  EXPECT_EQ(count("begun_without_stored_map"), 0U);
}

TEST_F(LocalizationInAStoredMap, BeginsAMapOfItsOwnWhereTheStoredOneIsOfAnotherProfile) {
  stored_map.write(wire::encode(
      "car", flow::StoredMap{kMap, 3, 0, {2}, 2.0 * LocalizerConfig().map.cell_size_m}));
  place(3);
  begin(continuing());
  localize(0, 1);
  EXPECT_EQ(submap_in_use, flow::SubmapId{0});
  EXPECT_EQ(count("begun_without_stored_map"), 1U);
  EXPECT_THAT(explanation(), ::testing::HasSubstr("another profile"));
}

TEST_F(LocalizationInAStoredMap, GoesOnAfterTheDriveBeforeThoughItsStampsGoBack) {
  store(3);
  place(3);
  begin(continuing());
  localize(0, 5);
  drive_id = 2;
  send(0);
  ASSERT_TRUE(comes_to([this] { return has_published(3); })) << "the end of the drive before";
  store(4);
  place(4);
  ASSERT_TRUE(comes_to([this] { return has_localized(6); }));
  EXPECT_EQ(submap_in_use, flow::SubmapId{4});
  EXPECT_EQ(sequences.back(), 0U);
  EXPECT_THAT(maps, ::testing::ElementsAre(kMap.value));
  EXPECT_EQ(odoms.size(), 2U) << "two drives in one map";
}

TEST_F(LocalizationInAStoredMap, ComesBackFromItsCheckpointWithoutWaiting) {
  store(3);
  place(3);
  begin(continuing());
  localize(0, 25);
  stop();
  stored_map.end(wire::encode("car", flow::StoredMap{}));
  begin(continuing());
  localize(26, 27);
  EXPECT_EQ(count("restored_checkpoints"), 1U);
  EXPECT_EQ(submap_in_use, flow::SubmapId{3});
  EXPECT_EQ(odoms.size(), 1U);
  EXPECT_THAT(explanation(), ::testing::HasSubstr("not found in the map"));
}

TEST_F(LocalizationInAStoredMap, HandsOverTheSubmapInWhichTheVehicleWasSwitchedOff) {
  store(3);
  place(3);
  begin(continuing());
  localize(0, 25);
  stop();
  restart_source();
  begin(continuing());
  drive_id = 2;
  send(0);
  ASSERT_TRUE(comes_to([this] { return has_published(3); }));
  store(4);
  place(4);
  ASSERT_TRUE(comes_to([this] { return has_localized(0) && submap_in_use == flow::SubmapId{4}; }));
}

TEST_F(LocalizationInAStoredMap, KeepsTheCheckpointOfAnotherMapOutOfIt) {
  begin();
  localize(0, 25);
  stop();
  restart_source();
  store(3);
  place(3);
  begin(continuing());
  drive_id = 2;
  localize(0, 1);
  EXPECT_EQ(submap_in_use, flow::SubmapId{3});
  EXPECT_FALSE(has_published(0));
}

}  // namespace
}  // namespace slammot::localization
