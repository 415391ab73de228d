#include "services/map_store/store.hpp"

#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sqlite3.h>

#include "tests/support/example_submap.hpp"
#include "tests/support/temporary_folder.hpp"

namespace slammot::map_store {
namespace {

using flow::SubmapId;
using slammot::testing::example_submap;
using slammot::testing::same_submap;
using ::testing::ElementsAre;

constexpr std::int64_t kHourNs = 3'600'000'000'000;

flow::Submap of_map(std::uint64_t map_id, flow::Submap submap) {
  submap.map_id = {map_id};
  return submap;
}

class StoreTest : public ::testing::Test {
 protected:
  Store open(const MapStoreConfig& config = {}) {
    auto store = Store::open(file_, config);
    if (const auto* fault = std::get_if<std::string>(&store)) throw std::runtime_error(*fault);
    return std::move(std::get<Store>(store));
  }

  slammot::testing::TemporaryFolder folder_;
  std::filesystem::path file_ = folder_ / "new folder/map.sqlite";
};

TEST_F(StoreTest, ReturnsAStoredSubmap) {
  Store store = open();
  EXPECT_EQ(store.put("car", example_submap(4)), PutResult::kStored);
  const auto submap = store.get("car", SubmapId{4});
  ASSERT_TRUE(submap);
  EXPECT_TRUE(same_submap(*submap, example_submap(4)));
}

TEST_F(StoreTest, ReturnsNothingForUnknownIds) {
  Store store = open();
  EXPECT_FALSE(store.get("car", SubmapId{0}));
  EXPECT_THAT(store.list("car"), ElementsAre());
  EXPECT_EQ(store.last_fault(), "");
}

TEST_F(StoreTest, PersistsAfterClosing) {
  open().put("car", example_submap(0));
  EXPECT_TRUE(open().get("car", SubmapId{0}));
}

TEST_F(StoreTest, KeepsVehiclesApart) {
  Store store = open();
  store.put("car", example_submap(0));
  store.put("bus", example_submap(0, kHourNs));
  store.put("bus", example_submap(1, kHourNs));
  EXPECT_THAT(store.vehicles(), ElementsAre("bus", "car"));
  EXPECT_THAT(store.list("bus"), ElementsAre(SubmapId{0}, SubmapId{1}));
  EXPECT_THAT(store.list("car"), ElementsAre(SubmapId{0}));
}

TEST_F(StoreTest, ListsAscendingForAnyOrderOfArrival) {
  Store store = open();
  for (const std::uint32_t id : {2U, 0U, 1U}) store.put("car", example_submap(id));
  EXPECT_THAT(store.list("car"), ElementsAre(SubmapId{0}, SubmapId{1}, SubmapId{2}));
}

TEST_F(StoreTest, IgnoresARepeatedSubmap) {
  Store store = open();
  store.put("car", example_submap(0));
  EXPECT_EQ(store.put("car", example_submap(0)), PutResult::kKnown);
  EXPECT_THAT(store.list("car"), ElementsAre(SubmapId{0}));
}

TEST_F(StoreTest, KeepsTheNewerOfTwoVersions) {
  flow::Submap older = example_submap(0);
  flow::Submap newer = older;
  newer.last_stamp_ns += 1;
  newer.travelled_m += 0.5;
  Store store = open();
  EXPECT_EQ(store.put("car", older), PutResult::kStored);
  EXPECT_EQ(store.put("car", newer), PutResult::kStored);
  EXPECT_EQ(store.put("car", older), PutResult::kOlder);
  EXPECT_TRUE(same_submap(*store.get("car", SubmapId{0}), newer));
}

TEST_F(StoreTest, KeepsTheMapsOfOneVehicleApart) {
  Store store = open();
  for (const std::uint32_t id : {0U, 1U, 2U}) store.put("car", of_map(7, example_submap(id)));
  EXPECT_EQ(store.put("car", of_map(8, example_submap(0))), PutResult::kStored)
      << "the same log, driven again";
  EXPECT_THAT(store.list("car"), ElementsAre(SubmapId{0}));
  EXPECT_EQ(store.get("car", SubmapId{0})->map_id, flow::MapId{8});
}

TEST_F(StoreTest, ChoosesTheMapWithTheLastAdditionAsTheLatest) {
  Store store = open();
  store.put("car", of_map(9, example_submap(0)));
  store.put("car", of_map(4, example_submap(0, kHourNs)));
  store.put("car", of_map(4, example_submap(1, kHourNs)));
  EXPECT_THAT(store.list("car"), ElementsAre(SubmapId{0}, SubmapId{1}));
}

TEST_F(StoreTest, DoesNotChangeTheLatestMapByARepeatedSubmap) {
  Store store = open();
  store.put("car", of_map(7, example_submap(0)));
  store.put("car", of_map(8, example_submap(0)));
  EXPECT_EQ(store.put("car", of_map(7, example_submap(0))), PutResult::kKnown);
  EXPECT_EQ(store.get("car", SubmapId{0})->map_id, flow::MapId{8});
}

TEST_F(StoreTest, ReadsTheDatabaseOfThePreviousVersion) {
  std::filesystem::create_directories(file_.parent_path());
  sqlite3* before = nullptr;
  ASSERT_EQ(sqlite3_open(file_.c_str(), &before), SQLITE_OK);
  ASSERT_EQ(
      sqlite3_exec(
          before,
          "CREATE TABLE submap (vehicle_id TEXT NOT NULL, drive INTEGER NOT NULL, submap_id "
          "INTEGER NOT NULL,"
          " first_stamp_ns INTEGER NOT NULL, last_stamp_ns INTEGER NOT NULL, record BLOB NOT NULL,"
          " PRIMARY KEY (vehicle_id, drive, submap_id)); INSERT INTO submap VALUES ('car', 3, 0, "
          "0, 1, x'00');"
          "PRAGMA user_version = 1",
          nullptr, nullptr, nullptr),
      SQLITE_OK);
  sqlite3_close(before);
  EXPECT_THAT(open().list("car"), ElementsAre(SubmapId{0}));
}

TEST_F(StoreTest, ReportsALockedDatabaseAndRecovers) {
  MapStoreConfig impatient;
  impatient.busy_timeout_s = 0.01;
  Store store = open(impatient);
  sqlite3* other = nullptr;
  ASSERT_EQ(sqlite3_open(file_.c_str(), &other), SQLITE_OK);
  ASSERT_EQ(sqlite3_exec(other, "BEGIN IMMEDIATE", nullptr, nullptr, nullptr), SQLITE_OK);
  EXPECT_EQ(store.put("car", example_submap(0)), PutResult::kFailed);
  EXPECT_EQ(store.last_fault(), "database is locked");
  sqlite3_exec(other, "ROLLBACK", nullptr, nullptr, nullptr);
  EXPECT_EQ(store.put("car", example_submap(0)), PutResult::kStored);
  EXPECT_EQ(store.last_fault(), "");
  sqlite3_close(other);
}

TEST_F(StoreTest, ReportsAFullDatabaseAndKeepsItsContent) {
  MapStoreConfig small;
  small.max_database_mb = 1;
  Store store = open(small);
  std::uint32_t id = 0;
  PutResult result = PutResult::kStored;
  while (result == PutResult::kStored && id < 20)
    result = store.put("car", example_submap(id++, 0, 600));
  EXPECT_EQ(result, PutResult::kFailed);
  EXPECT_EQ(store.last_fault(), "database or disk is full");
  EXPECT_EQ(store.list("car").size(), id - 1);
  EXPECT_TRUE(store.get("car", SubmapId{0}));
}

TEST_F(StoreTest, RejectsAFileThatIsNotADatabase) {
  std::filesystem::create_directories(file_.parent_path());
  std::ofstream(file_)
      << "This is a letter, and has been one for longer than a database header would be.\n";
  const auto store = Store::open(file_, {});
  ASSERT_TRUE(std::holds_alternative<std::string>(store));
  EXPECT_EQ(std::get<std::string>(store), file_.string() + ": file is not a database");
}

TEST_F(StoreTest, RejectsAnInvalidPath) {
  EXPECT_TRUE(std::holds_alternative<std::string>(Store::open("/proc/no/map.sqlite", {})));
}

TEST_F(StoreTest, NamesADamagedSubmap) {
  Store store = open();
  store.put("car", example_submap(0));
  sqlite3* other = nullptr;
  ASSERT_EQ(sqlite3_open(file_.c_str(), &other), SQLITE_OK);
  ASSERT_EQ(sqlite3_exec(other, "UPDATE submap SET record = x'00112233445566'", nullptr, nullptr,
                         nullptr),
            SQLITE_OK);
  sqlite3_close(other);
  EXPECT_FALSE(store.get("car", SubmapId{0}));
  EXPECT_EQ(store.last_fault(), "submap 0 is damaged");
}

TEST_F(StoreTest, MakesAnEarlierMapTheLatest) {
  Store store = open();
  for (const std::uint32_t id : {0U, 1U, 2U})
    ASSERT_EQ(store.put("car", of_map(7, example_submap(id))), PutResult::kStored);
  ASSERT_EQ(store.put("car", of_map(8, example_submap(0))), PutResult::kStored);
  ASSERT_EQ(store.put("truck", of_map(9, example_submap(0))), PutResult::kStored);
  ASSERT_EQ(store.maps("car").size(), 2U);
  EXPECT_EQ(store.maps("car").back().map_id, flow::MapId{8});
  EXPECT_TRUE(store.make_latest("car", {7}));
  EXPECT_THAT(store.list("car"), ElementsAre(SubmapId{0}, SubmapId{1}, SubmapId{2}));
  EXPECT_TRUE(same_submap(*store.get("car", SubmapId{2}), of_map(7, example_submap(2))));
  EXPECT_EQ(store.maps("car").back().map_id, flow::MapId{7});
  EXPECT_EQ(store.maps("car").back().submaps, 3);
}

TEST_F(StoreTest, RejectsAMapOfAnotherVehicle) {
  Store store = open();
  ASSERT_EQ(store.put("car", of_map(7, example_submap(0))), PutResult::kStored);
  ASSERT_EQ(store.put("truck", of_map(9, example_submap(0))), PutResult::kStored);
  EXPECT_FALSE(store.make_latest("car", {9}));
  EXPECT_EQ(store.last_fault(), "");
  EXPECT_EQ(store.maps("car").back().map_id, flow::MapId{7});
}

TEST_F(StoreTest, SeesThatItsFileIsThere) {
  Store store = open();
  store.put("car", example_submap(0));
  EXPECT_EQ(store.keep_file(), Store::FileState::kThere);
}

TEST_F(StoreTest, WritesADeletedDatabaseAnew) {
  Store store = open();
  store.put("car", of_map(7, example_submap(0)));
  store.put("car", of_map(3, example_submap(1)));
  std::filesystem::remove_all(file_.parent_path());
  EXPECT_EQ(store.keep_file(), Store::FileState::kWrittenAnew);
  EXPECT_EQ(store.put("car", of_map(3, example_submap(2))), PutResult::kStored);
  Store again = open();
  EXPECT_THAT(again.list("car"), ElementsAre(SubmapId{1}, SubmapId{2}));
  EXPECT_EQ(again.maps("car").size(), 2U);
  EXPECT_EQ(store.keep_file(), Store::FileState::kThere);
}

TEST_F(StoreTest, WritesADatabaseAnewWhoseJournalWasLeft) {
  Store store = open();
  store.put("car", example_submap(0));
  std::filesystem::remove(file_);
  EXPECT_EQ(store.keep_file(), Store::FileState::kWrittenAnew);
  EXPECT_THAT(open().list("car"), ElementsAre(SubmapId{0}));
}

TEST_F(StoreTest, LeavesAFileThatReplacedItsOwn) {
  Store store = open();
  store.put("car", example_submap(0));
  std::filesystem::rename(file_, folder_ / "moved.sqlite");
  std::ofstream(file_) << "of somebody else";
  EXPECT_EQ(store.keep_file(), Store::FileState::kGone);
  EXPECT_THAT(store.last_fault(), ::testing::HasSubstr("was replaced by another file"));
}

TEST_F(StoreTest, SaysWhyADeletedDatabaseCannotBeWrittenAnew) {
  Store store = open();
  std::filesystem::remove_all(file_.parent_path());
  std::ofstream(file_.parent_path()) << "no folder";
  EXPECT_EQ(store.keep_file(), Store::FileState::kGone);
  EXPECT_THAT(store.last_fault(), ::testing::HasSubstr("was deleted"));
  std::filesystem::remove(file_.parent_path());
  EXPECT_EQ(store.keep_file(), Store::FileState::kWrittenAnew);
}

TEST_F(StoreTest, WritesADatabaseAnewAfterAnAttemptThatDidNotFinish) {
  Store store = open();
  store.put("car", example_submap(0));
  std::filesystem::remove(file_);
  std::ofstream(file_.string() + ".unfinished") << "cut";
  EXPECT_EQ(store.keep_file(), Store::FileState::kWrittenAnew);
  EXPECT_THAT(open().list("car"), ElementsAre(SubmapId{0}));
}

}  // namespace
}  // namespace slammot::map_store
