#include "common/dds/reader_watch.hpp"

#include <optional>

#include <gtest/gtest.h>

#include "common/dds/reader.hpp"
#include "tests/support/dds.hpp"

namespace slammot::dds {
namespace {

using slammot::testing::kForever;
using slammot::testing::PrivateBus;

struct WatchedWriter : ::testing::Test {
  PrivateBus bus;
  Participant here = bus.join();
  Participant there = bus.join();
  Writer<slammot_StoredMap> writer{here, topics::kStoredMap};
  ReaderWatch watch{writer};

  void wait_for(std::uint32_t readers) {
    while (writer.matched_readers() > readers) {}
    ASSERT_TRUE(writer.wait_for_readers(readers, kForever));
  }
};

TEST_F(WatchedWriter, NoticesEachReaderOnce) {
  EXPECT_FALSE(watch.has_new());
  const Reader<slammot_StoredMap> first(there, topics::kStoredMap);
  wait_for(1);
  EXPECT_TRUE(watch.has_new());
  EXPECT_FALSE(watch.has_new());
  const Reader<slammot_StoredMap> second(there, topics::kStoredMap);
  const Reader<slammot_StoredMap> third(there, topics::kStoredMap);
  wait_for(3);
  EXPECT_TRUE(watch.has_new());
  EXPECT_FALSE(watch.has_new());
}

TEST_F(WatchedWriter, NoticesAReaderThatReplacesAnother) {
  std::optional<Reader<slammot_StoredMap>> reader(std::in_place, there, topics::kStoredMap);
  wait_for(1);
  EXPECT_TRUE(watch.has_new());
  reader.reset();
  wait_for(0);
  reader.emplace(there, topics::kStoredMap);
  wait_for(1);
  EXPECT_TRUE(watch.has_new());
  reader.reset();
  wait_for(0);
  EXPECT_FALSE(watch.has_new()) << "a reader that leaves is none that joins";
}

}  // namespace
}  // namespace slammot::dds
