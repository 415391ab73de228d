#include "services/map_store/map_store_service.hpp"

#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sqlite3.h>

#include "tests/support/example_submap.hpp"
#include "tests/support/service_on_the_bus.hpp"

namespace slammot::map_store {
namespace {

using slammot::testing::assign;
using slammot::testing::example_submap;
using slammot::testing::kForever;

struct MapStoreOnTheBus : slammot::testing::ServiceOnTheBus {
  dds::Writer<slammot_SubmapTile> tiles{neighbour_, dds::topics::kSubmapTile};
  std::map<flow::SubmapId, flow::Submap> stored;

  /// What a reader receives that joins now.
  struct LateReader {
    dds::Reader<slammot_SubmapTile> reader;
    wire::SubmapAssembler assembler;
  };
  LateReader late{{neighbour_, dds::topics::kStoredSubmapTile}, {}};

  bool has_stored(std::size_t count) {
    late.reader.take_each([&](const slammot_SubmapTile& tile) {
      if (auto added = late.assembler.add(tile); added.submap)
        stored[added.submap->submap_id] = std::move(*added.submap);
    });
    return stored.size() >= count;
  }
  dds::Reader<slammot_StoredMap> stored_map{neighbour_, dds::topics::kStoredMap};
  std::optional<flow::StoredMap> said;

  bool has_said_what_it_has() {
    stored_map.take_each([this](const slammot_StoredMap& sample) {
      const auto decoded = wire::decode(sample);
      EXPECT_TRUE(decoded) << decoded.fault();
      if (decoded) said = *decoded;
    });
    return said.has_value();
  }
  void finish(const flow::Submap& submap) {
    wire::SubmapEncoder().encode("car", submap,
                                 [this](const slammot_SubmapTile& tile) { tiles.write(tile); });
  }
};

TEST_F(MapStoreOnTheBus, PublishesASubmapOnceItIsCommitted) {
  start<MapStoreService>("map_store");
  finish(example_submap(0, 0, 300));
  ASSERT_TRUE(comes_to([&] { return has_stored(1); }));
  EXPECT_TRUE(slammot::testing::same_submap(stored.at({0}), example_submap(0, 0, 300)));
  auto store = Store::open(folder_ / "map.sqlite", {});
  EXPECT_TRUE(std::get<Store>(store).get("car", {0}));
}

TEST_F(MapStoreOnTheBus, PublishesAllStoredSubmapsAfterARestart) {
  start<MapStoreService>("map_store");
  for (const std::uint32_t id : {0U, 1U, 2U}) finish(example_submap(id));
  ASSERT_TRUE(comes_to([&] { return has_stored(3); }));
  stop();
  stored.clear();
  late.assembler = {};
  start<MapStoreService>("map_store");
  EXPECT_TRUE(comes_to([&] { return has_stored(3); }));
}

TEST_F(MapStoreOnTheBus, FreesTilesThatAllReadersHaveAndReadsThemAgainForAReaderThatJoins) {
  dds::Reader<slammot_SubmapTile> early(neighbour_, dds::topics::kStoredSubmapTile);
  start<MapStoreService>("map_store");
  for (const std::uint32_t id : {0U, 1U, 2U}) finish(example_submap(id));
  std::set<std::uint64_t> received;
  std::set<std::uint64_t> freed;
  ASSERT_TRUE(comes_to([&] {
    early.take_each([&](const slammot_SubmapTile&,
                        const dds::SampleInfo& info) { received.insert(info.key_handle); },
                    [&](const dds::SampleInfo& info) { freed.insert(info.key_handle); });
    return has_stored(3) && freed.size() >= 3 && freed == received;
  }));
  stored.clear();
  late = {{neighbour_, dds::topics::kStoredSubmapTile}, {}};
  ASSERT_TRUE(comes_to([&] { return has_stored(3); }));
  EXPECT_TRUE(slammot::testing::same_submap(stored.at({1}), example_submap(1)));
}

TEST_F(MapStoreOnTheBus, PublishesTheDescriptionOfTheStoredMap) {
  start<MapStoreService>("map_store");
  ASSERT_TRUE(comes_to([&] { return has_said_what_it_has(); }));
  EXPECT_EQ(said->submaps, 0U) << "an empty map is published, too";
  for (const std::uint32_t id : {0U, 1U, 2U}) finish(example_submap(id));
  ASSERT_TRUE(comes_to([&] { return has_said_what_it_has() && said->submaps == 3; }));
  EXPECT_EQ(said->map_id, example_submap(0).map_id);
  EXPECT_EQ(said->last_submap_id, flow::SubmapId{2});
  EXPECT_EQ(said->cell_size_m, example_submap(0).cell_size_m);
  flow::Submap of_next_map = example_submap(0);
  of_next_map.map_id = {99};
  finish(of_next_map);
  ASSERT_TRUE(
      comes_to([&] { return has_said_what_it_has() && said->map_id == of_next_map.map_id; }));
  EXPECT_EQ(said->submaps, 1U);
}

TEST_F(MapStoreOnTheBus, ReportsADamagedSubmapUntilItIsReplaced) {
  {
    auto store = Store::open(folder_ / "map.sqlite", {});
    for (const std::uint32_t id : {0U, 1U, 2U})
      ASSERT_EQ(std::get<Store>(store).put("car", example_submap(id)), PutResult::kStored);
  }
  sqlite3* database = nullptr;
  ASSERT_EQ(sqlite3_open((folder_ / "map.sqlite").c_str(), &database), SQLITE_OK);
  ASSERT_EQ(sqlite3_exec(database, "UPDATE submap SET record = x'00ff' WHERE submap_id = 2",
                         nullptr, nullptr, nullptr),
            SQLITE_OK);
  sqlite3_close(database);
  start<MapStoreService>("map_store");
  ASSERT_TRUE(comes_to([&] { return has_said_what_it_has(); }));
  EXPECT_EQ(said->submaps, 2U);
  EXPECT_EQ(said->unreadable, 1U);
  EXPECT_EQ(said->last_submap_id, flow::SubmapId{2}) << "its number stays taken";
  finish(example_submap(2));
  ASSERT_TRUE(comes_to([&] { return has_said_what_it_has() && said->submaps == 3; }));
  EXPECT_EQ(said->unreadable, 0U);
}

TEST_F(MapStoreOnTheBus, PublishesNoMapOfAnotherVehicle) {
  {
    auto store = Store::open(folder_ / "map.sqlite", {});
    ASSERT_EQ(std::get<Store>(store).put("truck", example_submap(0)), PutResult::kStored);
  }
  start<MapStoreService>("map_store");
  ASSERT_TRUE(comes_to([&] { return has_said_what_it_has(); }));
  EXPECT_EQ(said->submaps, 0U);
  EXPECT_EQ(context_->status().counter("other_vehicles"), 1U);
}

TEST_F(MapStoreOnTheBus, KeepsASubmapInMemoryWhileTheDatabaseIsLocked) {
  MapStoreService::Settings impatient;
  impatient.config.busy_timeout_s = 0.01;
  impatient.config.retry_after_s = 0.05;
  start<MapStoreService>("map_store", impatient);
  sqlite3* other = nullptr;
  ASSERT_EQ(sqlite3_open((folder_ / "map.sqlite").c_str(), &other), SQLITE_OK);
  ASSERT_EQ(sqlite3_exec(other, "BEGIN IMMEDIATE", nullptr, nullptr, nullptr), SQLITE_OK);
  finish(example_submap(0));
  ASSERT_TRUE(comes_to([&] { return context_->status().counter("unwritten_submaps") == 1; }));
  EXPECT_EQ(context_->status().state(std::chrono::steady_clock::now()),
            app::ServiceState::kDegraded);
  EXPECT_FALSE(has_stored(1));
  sqlite3_exec(other, "ROLLBACK", nullptr, nullptr, nullptr);
  sqlite3_close(other);
  ASSERT_TRUE(comes_to([&] { return has_stored(1); }));
  EXPECT_EQ(context_->status().state(std::chrono::steady_clock::now()),
            app::ServiceState::kRunning);
}

TEST_F(MapStoreOnTheBus, RelaysTheLastTracksToALateTrackingService) {
  start<MapStoreService>("map_store");
  dds::Writer<slammot_TrackedObjects> objects(neighbour_, dds::topics::kTrackedObjects);
  ASSERT_TRUE(objects.wait_for_readers(1, kForever));
  slammot_TrackedObjects sample{};
  assign(sample.vehicle_id, "car");
  sample.stamp_ns = 42;
  objects.write(sample);
  ASSERT_TRUE(
      comes_to([&] { return objects.wait_for_acknowledgements(std::chrono::milliseconds(1)); }));
  dds::Reader<slammot_TrackedObjects> late_reader(neighbour_, dds::topics::kStoredTrackedObjects);
  std::int64_t stamp_ns = 0;
  EXPECT_TRUE(comes_to([&] {
    late_reader.take_each([&](const slammot_TrackedObjects& kept) { stamp_ns = kept.stamp_ns; });
    return stamp_ns == 42;
  }));
}

TEST_F(MapStoreOnTheBus, TellsATrackingServiceThatNoTracksAreStored) {
  start<MapStoreService>("map_store");
  dds::Reader<slammot_TrackedObjects> reader(neighbour_, dds::topics::kStoredTrackedObjects);
  bool is_told = false;
  EXPECT_TRUE(comes_to([&] {
    reader.take_each(
        [&](const slammot_TrackedObjects& none) { is_told = none.objects._length == 0; });
    return is_told;
  }));
}

TEST_F(MapStoreOnTheBus, CannotStartWithoutItsDatabase) {
  MapStoreService::Settings settings;
  settings.database = "/proc/no/map.sqlite";
  EXPECT_THROW(start<MapStoreService>("map_store", settings), app::Unavailable);
}

TEST_F(MapStoreOnTheBus, CannotStartWithAnUnknownMap) {
  MapStoreService::Settings settings;
  settings.map_id = 99;
  EXPECT_THROW(start<MapStoreService>("map_store", settings), app::StartupFailure);
}

}  // namespace
}  // namespace slammot::map_store
