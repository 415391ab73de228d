#include <gtest/gtest.h>

#include "services/map_store/store.hpp"
#include "services/slammot/stored_map.hpp"
#include "tests/support/example_streams.hpp"
#include "tests/support/example_submap.hpp"
#include "tests/support/temporary_folder.hpp"

namespace slammot {
namespace {

using map_store::Store;
using testing::example_streams;
using testing::example_submap;

struct StoredTraffic : ::testing::Test {
  testing::TemporaryFolder first;
  testing::TemporaryFolder second;

  static Store store_in(const testing::TemporaryFolder& folder) {
    auto opened = Store::open(folder / "map.sqlite", {});
    return std::move(std::get<Store>(opened));
  }
};

TEST_F(StoredTraffic, GoesAlongWithTheMapUnderItsNewName) {
  ASSERT_FALSE(write_stored_map(first.path(), {example_submap(0), example_submap(1)}, "bus"));
  ASSERT_TRUE(store_in(first).add_traffic("bus", example_submap(0).map_id, {1}, example_streams()));
  flow::Submap copied = example_submap(1);
  copied.map_id = {};
  ASSERT_FALSE(write_stored_map(second.path(), {copied}, "car"));
  ASSERT_FALSE(copy_traffic(first.path(), second.path()));
  const auto traffic = store_in(second).traffic("car", {});
  ASSERT_EQ(traffic.size(), 1U);
  EXPECT_EQ(traffic[0].submap_id, flow::SubmapId{1});
  ASSERT_TRUE(traffic[0].streams);
  EXPECT_EQ(traffic[0].streams->size(), example_streams().size());
}

TEST_F(StoredTraffic, OfAMapWithoutAnyIsNone) {
  ASSERT_FALSE(write_stored_map(first.path(), {example_submap(0)}, "bus"));
  ASSERT_FALSE(write_stored_map(second.path(), {example_submap(0)}, "car"));
  EXPECT_FALSE(copy_traffic(first.path(), second.path()));
  EXPECT_TRUE(store_in(second).traffic("car", example_submap(0).map_id).empty());
}

TEST_F(StoredTraffic, IsAddedToWhatASubmapHas) {
  ASSERT_FALSE(write_stored_map(first.path(), {example_submap(0)}, "car"));
  const traffic::SubmapTraffic traffic{{{0}, example_streams()}};
  ASSERT_FALSE(write_stored_traffic(first.path(), traffic));
  ASSERT_FALSE(write_stored_traffic(first.path(), traffic));
  const auto stored = read_stored_traffic(first.path());
  ASSERT_TRUE(stored);
  EXPECT_EQ(stored->at({0}).size(), 2 * example_streams().size());
}

TEST(StoredMap, KnowsSubmapsOfAnotherMapAgain) {
  const std::vector<flow::Submap> part{example_submap(0), example_submap(1)};
  std::vector<flow::Submap> joint{example_submap(7), example_submap(0), example_submap(1)};
  joint[2].submap_id = {2};  // as a merge renumbers and moves them
  joint[2].odom_from_submap = {40.0, 3.0, 1.0};
  joint[2].previous_from_submap.pose = {1.0, 0.0, 0.0};
  EXPECT_EQ(submaps_in_common(joint, part), 2U);
  EXPECT_EQ(submaps_in_common(part, part), 2U);
  EXPECT_EQ(submaps_in_common(part, {example_submap(2), example_submap(3)}), 0U);
}

}  // namespace
}  // namespace slammot
