#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sqlite3.h>

#include "services/map_store/store.hpp"
#include "tests/support/example_streams.hpp"
#include "tests/support/example_submap.hpp"
#include "tests/support/temporary_folder.hpp"

namespace slammot::map_store {
namespace {

using slammot::testing::example_streams;
using slammot::testing::example_submap;
using slammot::testing::same_stream;

class StoreTrafficTest : public ::testing::Test {
 protected:
  Store open(const MapStoreConfig& config = {}) {
    auto store = Store::open(file_, config);
    if (const auto* fault = std::get_if<std::string>(&store)) throw std::runtime_error(*fault);
    return std::move(std::get<Store>(store));
  }

  void execute(const char* sql) {
    sqlite3* database = nullptr;
    ASSERT_EQ(sqlite3_open(file_.c_str(), &database), SQLITE_OK);
    EXPECT_EQ(sqlite3_exec(database, sql, nullptr, nullptr, nullptr), SQLITE_OK);
    sqlite3_close(database);
  }

  slammot::testing::TemporaryFolder folder_;
  std::filesystem::path file_ = folder_ / "map.sqlite";
};

TEST_F(StoreTrafficTest, ReturnsWhatMovedInAMapAfterClosing) {
  {
    Store store = open();
    EXPECT_TRUE(store.add_traffic("car", {7}, {3}, example_streams(2.0F)));
    EXPECT_TRUE(store.add_traffic("car", {7}, {1}, example_streams()));
    EXPECT_TRUE(store.add_traffic("car", {8}, {1}, example_streams()));
    EXPECT_TRUE(store.add_traffic("bus", {7}, {2}, example_streams()));
  }
  const auto traffic = open().traffic("car", {7});
  ASSERT_EQ(traffic.size(), 2U);
  EXPECT_EQ(traffic[0].submap_id, flow::SubmapId{1});
  EXPECT_EQ(traffic[1].submap_id, flow::SubmapId{3});
  ASSERT_TRUE(traffic[1].streams);
  EXPECT_TRUE(same_stream(traffic[1].streams->at(7), example_streams(2.0F)[7]));
}

TEST_F(StoreTrafficTest, AddsToWhatTheSubmapHas) {
  Store store = open();
  EXPECT_TRUE(store.add_traffic("car", {7}, {1}, example_streams()));
  EXPECT_TRUE(store.add_traffic("car", {7}, {1}, example_streams(3.0F)));
  const auto traffic = store.traffic("car", {7});
  ASSERT_EQ(traffic.size(), 1U);
  ASSERT_TRUE(traffic[0].streams);
  EXPECT_EQ(traffic[0].streams->size(), 2 * example_streams().size());
}

TEST_F(StoreTrafficTest, ExtendsADatabaseWithoutTraffic) {
  open().put("car", example_submap(0));
  execute("DROP TABLE traffic");
  Store store = open();
  EXPECT_TRUE(store.traffic("car", example_submap(0).map_id).empty());
  EXPECT_EQ(store.last_fault(), "");
  EXPECT_TRUE(store.add_traffic("car", example_submap(0).map_id, {0}, example_streams()));
  EXPECT_TRUE(store.get("car", {0})) << "its submaps are as before";
}

TEST_F(StoreTrafficTest, DoesNotChangeTheLatestMap) {
  Store store = open();
  flow::Submap of_other_map = example_submap(0);
  of_other_map.map_id = {4};
  store.put("car", of_other_map);
  store.put("car", example_submap(0));
  store.add_traffic("car", {4}, {0}, example_streams());
  EXPECT_EQ(store.maps("car").back().map_id, example_submap(0).map_id);
}

TEST_F(StoreTrafficTest, NamesADamagedRecordAndReplacesIt) {
  Store store = open();
  store.add_traffic("car", {7}, {0}, example_streams());
  store.add_traffic("car", {7}, {1}, example_streams());
  execute("UPDATE traffic SET record = x'00112233445566' WHERE submap_id = 0");
  const auto traffic = store.traffic("car", {7});
  ASSERT_EQ(traffic.size(), 2U);
  EXPECT_FALSE(traffic[0].streams);
  EXPECT_TRUE(traffic[1].streams);
  EXPECT_TRUE(store.add_traffic("car", {7}, {0}, example_streams()));
  EXPECT_TRUE(store.traffic("car", {7})[0].streams);
}

TEST_F(StoreTrafficTest, ReportsALockedDatabaseAndRecovers) {
  MapStoreConfig impatient;
  impatient.busy_timeout_s = 0.01;
  Store store = open(impatient);
  sqlite3* other = nullptr;
  ASSERT_EQ(sqlite3_open(file_.c_str(), &other), SQLITE_OK);
  ASSERT_EQ(sqlite3_exec(other, "BEGIN IMMEDIATE", nullptr, nullptr, nullptr), SQLITE_OK);
  EXPECT_FALSE(store.add_traffic("car", {7}, {0}, example_streams()));
  EXPECT_EQ(store.last_fault(), "database is locked");
  sqlite3_exec(other, "ROLLBACK", nullptr, nullptr, nullptr);
  EXPECT_TRUE(store.add_traffic("car", {7}, {0}, example_streams()));
  sqlite3_close(other);
}

}  // namespace
}  // namespace slammot::map_store
