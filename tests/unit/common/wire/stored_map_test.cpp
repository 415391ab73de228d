#include "common/wire/stored_map.hpp"

#include <gtest/gtest.h>

#include "tests/support/values.hpp"

namespace slammot::wire {
namespace {

constexpr flow::StoredMap kMap{{1'700'000'000'000'000'001}, 20, 2, {24}, 0.2};

TEST(StoredMapOnTheWire, ComesBackAsItWas) {
  const auto back = decode(encode("car", kMap));
  ASSERT_TRUE(back) << back.fault();
  EXPECT_EQ(back->map_id, kMap.map_id);
  EXPECT_EQ(back->submaps, kMap.submaps);
  EXPECT_EQ(back->unreadable, kMap.unreadable);
  EXPECT_EQ(back->last_submap_id, kMap.last_submap_id);
  EXPECT_EQ(back->cell_size_m, kMap.cell_size_m);
}

TEST(StoredMapOnTheWire, OfNothingIsSound) {
  EXPECT_TRUE(decode(encode("car", flow::StoredMap{})));
}

TEST(StoredMapOnTheWire, IsRefusedWhereItIsUnsound) {
  const auto fault_after = [](auto corrupt) {
    slammot_StoredMap sample = encode("car", kMap);
    corrupt(sample);
    return decode(sample).fault();
  };
  EXPECT_EQ(fault_after([](auto&) {}), "");
  EXPECT_NE(fault_after([](auto& s) { s.cell_size_m = slammot::testing::kNan; }), "");
  EXPECT_NE(fault_after([](auto& s) { s.cell_size_m = -0.2; }), "");
  EXPECT_NE(fault_after([](auto& s) { s.submap_count = 24; }), "") << "26 submaps in 25 numbers";
}

}  // namespace
}  // namespace slammot::wire
