#include "services/map_store/traffic_record.hpp"

#include <limits>

#include <gtest/gtest.h>

#include "tests/support/example_streams.hpp"

namespace slammot::map_store {
namespace {

using slammot::testing::example_streams;
using slammot::testing::same_stream;
using traffic::FreeStream;

TEST(TrafficRecord, IsEqualAfterReadingBack) {
  auto streams = example_streams();
  streams[1].mover = traffic::Mover::kPedestrian;
  streams[2].passages = 77;
  const auto back = from_traffic_blob(to_traffic_blob(streams));
  ASSERT_TRUE(back);
  EXPECT_TRUE(std::equal(back->begin(), back->end(), streams.begin(), streams.end(), same_stream));
}

TEST(TrafficRecord, OfNothingIsReadable) {
  const auto back = from_traffic_blob(to_traffic_blob({}));
  ASSERT_TRUE(back);
  EXPECT_TRUE(back->empty());
}

TEST(TrafficRecord, IsNotReadFromADamagedBlob) {
  const std::string blob = to_traffic_blob(example_streams());
  for (std::size_t at = 0; at < blob.size(); at += 3) {
    EXPECT_FALSE(from_traffic_blob(blob.substr(0, at))) << at;
    std::string damaged = blob;
    damaged[at] = static_cast<char>(damaged[at] ^ 0x40);
    EXPECT_FALSE(from_traffic_blob(damaged)) << at;
  }
}

TEST(TrafficRecord, WithUnsoundNumbersIsRejected) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const auto is_read = [](auto corrupt) {
    auto streams = example_streams();
    corrupt(streams[5]);
    return from_traffic_blob(to_traffic_blob(streams)).has_value();
  };
  EXPECT_TRUE(is_read([](FreeStream&) {}));
  EXPECT_FALSE(is_read([](FreeStream& s) { s.mover = static_cast<traffic::Mover>(3); }));
  EXPECT_FALSE(is_read([&](FreeStream& s) { s.position_m.x() = nan; }));
  EXPECT_FALSE(is_read([](FreeStream& s) { s.position_m.y() = -2e6F; }));
  EXPECT_FALSE(is_read([](FreeStream& s) { s.weight = 0.0F; }));
  EXPECT_FALSE(is_read([&](FreeStream& s) { s.weight = nan; }));
  EXPECT_FALSE(is_read([](FreeStream& s) { s.length_m = -1.0F; }));
  EXPECT_FALSE(is_read([](FreeStream& s) { s.direction_sum.setZero(); }));
  EXPECT_FALSE(is_read([&](FreeStream& s) { s.direction_sum.y() = nan; }));
  EXPECT_FALSE(is_read([](FreeStream& s) { s.squared_speed_sum = 1e30F; }));
}

}  // namespace
}  // namespace slammot::map_store
