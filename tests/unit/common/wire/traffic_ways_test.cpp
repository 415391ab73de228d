#include "common/wire/traffic_ways.hpp"

#include <algorithm>

#include <gtest/gtest.h>

#include "common/dds/serialized_size.hpp"
#include "common/dds/topic_table.hpp"
#include "tests/support/values.hpp"

namespace slammot::wire {
namespace {

using slammot::testing::kNanF;
using slammot::testing::way;
using traffic::Mover;

struct KeptWays {
  explicit KeptWays(const slammot_TrafficWays& part)
      : ways(part.ways._buffer, part.ways._buffer + part.ways._length),
        points(part.points._buffer, part.points._buffer + part.points._length),
        sample(part) {}

  slammot_TrafficWays& shown() {
    sample.ways._buffer = ways.data();
    sample.points._buffer = points.data();
    return sample;
  }

  std::vector<slammot_TrafficWay> ways;
  std::vector<slammot_Point2f> points;
  slammot_TrafficWays sample;
};

struct WaysInParts : ::testing::Test {
  TrafficWaysAssembler assembler;
  std::size_t left_out = 0;

  static traffic::TrafficWays ways(std::size_t count, int points = 3) {
    traffic::TrafficWays made{9, 1'700'000'000'123'456'789, {17}, {}};
    for (std::size_t i = 0; i < count; ++i)
      made.ways.push_back(way(static_cast<Mover>(i % 3), points));
    return made;
  }

  std::vector<KeptWays> parts_of(const traffic::TrafficWays& whole) {
    std::vector<KeptWays> parts;
    left_out = TrafficWaysEncoder().encode(
        "car", whole, [&](const slammot_TrafficWays& part) { parts.emplace_back(part); });
    return parts;
  }

  std::optional<traffic::TrafficWays> assemble(std::vector<KeptWays>& parts) {
    std::optional<traffic::TrafficWays> result;
    for (KeptWays& part : parts) {
      auto added = assembler.add(part.shown());
      EXPECT_EQ(added.fault, "");
      if (added.ways) result = std::move(added.ways);
    }
    return result;
  }

  static void expect_same(const traffic::Way& a, const traffic::Way& b) {
    EXPECT_EQ(a.mover, b.mover);
    EXPECT_EQ(a.line, b.line);
    EXPECT_EQ(a.speed_mps, b.speed_mps);
    EXPECT_EQ(a.speed_spread_mps, b.speed_spread_mps);
    EXPECT_EQ(a.width_m, b.width_m);
    EXPECT_EQ(a.tracks, b.tracks);
    EXPECT_EQ(a.confidence, b.confidence);
    EXPECT_EQ(a.points_in_map_m, b.points_in_map_m);
  }
};

TEST_F(WaysInParts, ComeBackAsTheyWere) {
  for (const std::size_t count : {std::size_t{0}, std::size_t{1}, kMostWaysOfPart,
                                  kMostWaysOfPart + 1, 3 * kMostWaysOfPart}) {
    const traffic::TrafficWays whole = ways(count);
    auto parts = parts_of(whole);
    std::ranges::reverse(parts);
    const auto back = assemble(parts);
    ASSERT_TRUE(back.has_value()) << count;
    EXPECT_EQ(back->sequence, whole.sequence);
    EXPECT_EQ(back->stamp_ns, whole.stamp_ns);
    EXPECT_EQ(back->map_id, whole.map_id);
    ASSERT_EQ(back->ways.size(), count);
    for (std::size_t i = 0; i < count; ++i) expect_same(back->ways[i], whole.ways[i]);
  }
}

TEST_F(WaysInParts, FitTheBus) {
  constexpr std::size_t kMostBytes = 128 * 1024;
  for (const int points : {2, 8, 26, 9000}) {
    for (KeptWays& part : parts_of(ways(3000, points))) {
      EXPECT_LE(part.points.size(), kMostWayPointsOfPart);
      EXPECT_LE(dds::serialized_bytes(dds::topics::kTrafficWays, part.shown()), kMostBytes);
    }
  }
}

TEST_F(WaysInParts, BeyondTheMostPartsAreLeftOutAndCounted) {
  const std::size_t fitting = kMostPartsOfWays * kMostWaysOfPart;
  auto parts = parts_of(ways(fitting + 7));
  EXPECT_EQ(parts.size(), kMostPartsOfWays);
  EXPECT_EQ(left_out, 7U);
  const auto back = assemble(parts);
  ASSERT_TRUE(back.has_value());
  EXPECT_EQ(back->ways.size(), fitting);
}

TEST_F(WaysInParts, DoNotComeWhereAPartIsMissing) {
  auto parts = parts_of(ways(2 * kMostWaysOfPart));
  ASSERT_EQ(parts.size(), 2U);
  parts.pop_back();
  EXPECT_FALSE(assemble(parts).has_value());
}

TEST_F(WaysInParts, AreNotMixedUpWithEarlierOnesOfTheSameNumber) {
  auto old_parts = parts_of(ways(2 * kMostWaysOfPart));
  old_parts.erase(old_parts.begin());
  EXPECT_FALSE(assemble(old_parts).has_value());
  traffic::TrafficWays newer = ways(2 * kMostWaysOfPart);
  newer.stamp_ns += 1;
  auto parts = parts_of(newer);
  parts.pop_back();
  EXPECT_FALSE(assemble(parts).has_value());
}

TEST_F(WaysInParts, AreRefusedWhereTheyAreUnsound) {
  const auto fault_after = [this](auto corrupt) {
    KeptWays part = parts_of(ways(3)).front();
    corrupt(part.shown());
    return TrafficWaysAssembler().add(part.sample).fault;
  };
  EXPECT_EQ(fault_after([](auto&) {}), "");
  EXPECT_NE(fault_after([](auto& s) { s.part_count = 0; }), "");
  EXPECT_NE(fault_after([](auto& s) { s.part_count = kMostPartsOfWays + 1; }), "");
  EXPECT_NE(fault_after([](auto& s) { s.part_index = 1; }), "");
  EXPECT_NE(fault_after([](auto& s) { s.ways._buffer[1].kind = static_cast<slammot_WayKind>(3); }),
            "");
  EXPECT_NE(fault_after([](auto& s) { s.ways._buffer[1].line_number = 0xFFFF'FFFF; }), "");
  EXPECT_NE(fault_after([](auto& s) { s.ways._buffer[1].point_count = 1; }), "");
  EXPECT_NE(fault_after([](auto& s) { s.ways._buffer[1].point_count = 0xFFFF'FFFF; }), "");
  EXPECT_NE(fault_after([](auto& s) { s.ways._buffer[1].speed_mps = kNanF; }), "");
  EXPECT_NE(fault_after([](auto& s) { s.ways._buffer[1].width_m = -1.0F; }), "");
  EXPECT_NE(fault_after([](auto& s) { s.ways._buffer[1].confidence = 1.5F; }), "");
  EXPECT_NE(fault_after([](auto& s) { s.points._buffer[4].y_m = kNanF; }), "");
  EXPECT_NE(fault_after([](auto& s) { --s.points._length; }), "");
}

}  // namespace
}  // namespace slammot::wire
