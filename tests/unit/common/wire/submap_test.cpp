#include "common/wire/submap.hpp"

#include <algorithm>
#include <memory>
#include <stdexcept>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/matchers.hpp"
#include "tests/support/values.hpp"

namespace slammot::wire {
namespace {

using slammot::testing::kNan;
using slammot::testing::kNanF;

/// A tile with its own copy of what the encoder lends.
struct KeptTile {
  explicit KeptTile(const slammot_SubmapTile& tile)
      : so(tile.so_log_odds_plus_128._buffer,
           tile.so_log_odds_plus_128._buffer + tile.so_log_odds_plus_128._length),
        mo(tile.mo_evidence._buffer, tile.mo_evidence._buffer + tile.mo_evidence._length),
        surfels(tile.surfels._buffer, tile.surfels._buffer + tile.surfels._length),
        fixes(tile.fixes._buffer, tile.fixes._buffer + tile.fixes._length),
        headings(tile.headings._buffer, tile.headings._buffer + tile.headings._length),
        sample(tile) {}

  slammot_SubmapTile& shown() {
    sample.so_log_odds_plus_128._buffer = so.data();
    sample.mo_evidence._buffer = mo.data();
    sample.surfels._buffer = surfels.data();
    sample.fixes._buffer = fixes.data();
    sample.headings._buffer = headings.data();
    return sample;
  }

  std::vector<std::uint8_t> so;
  std::vector<std::uint8_t> mo;
  std::vector<slammot_Surfel> surfels;
  std::vector<slammot_SubmapFix> fixes;
  std::vector<slammot_SubmapHeading> headings;
  slammot_SubmapTile sample;
};

std::vector<KeptTile> tiles_of(const flow::Submap& submap) {
  std::vector<KeptTile> tiles;
  SubmapEncoder().encode("car", submap,
                         [&](const slammot_SubmapTile& tile) { tiles.emplace_back(tile); });
  return tiles;
}

void expect_same(const flow::Submap& a, const flow::Submap& b) {
  EXPECT_EQ(a.submap_id, b.submap_id);
  EXPECT_EQ(a.first_stamp_ns, b.first_stamp_ns);
  EXPECT_EQ(a.last_stamp_ns, b.last_stamp_ns);
  EXPECT_EQ(a.odom_from_submap, b.odom_from_submap);
  EXPECT_EQ(a.previous_from_submap.pose, b.previous_from_submap.pose);
  EXPECT_EQ(a.previous_from_submap.covariance, b.previous_from_submap.covariance);
  EXPECT_EQ(a.submap_from_base_at_end, b.submap_from_base_at_end);
  EXPECT_EQ(a.travelled_m, b.travelled_m);
  EXPECT_EQ(a.cell_size_m, b.cell_size_m);
  EXPECT_EQ(a.min_x_m, b.min_x_m);
  EXPECT_EQ(a.min_y_m, b.min_y_m);
  EXPECT_EQ(a.columns, b.columns);
  EXPECT_EQ(a.rows, b.rows);
  EXPECT_EQ(a.so_log_odds, b.so_log_odds);
  EXPECT_EQ(a.mo_evidence, b.mo_evidence);
  EXPECT_EQ(a.saliency, b.saliency);
  ASSERT_EQ(a.surfels.size(), b.surfels.size());
  for (std::size_t i = 0; i < a.surfels.size(); ++i) {
    EXPECT_EQ(a.surfels[i].x_m, b.surfels[i].x_m);
    EXPECT_EQ(a.surfels[i].y_m, b.surfels[i].y_m);
    EXPECT_EQ(a.surfels[i].normal_x, b.surfels[i].normal_x);
    EXPECT_EQ(a.surfels[i].normal_y, b.surfels[i].normal_y);
    EXPECT_EQ(a.surfels[i].weight, b.surfels[i].weight);
  }
  ASSERT_EQ(a.fixes.size(), b.fixes.size());
  for (std::size_t i = 0; i < a.fixes.size(); ++i) {
    EXPECT_EQ(a.fixes[i].x_m, b.fixes[i].x_m);
    EXPECT_EQ(a.fixes[i].position.latitude_deg, b.fixes[i].position.latitude_deg);
    EXPECT_EQ(a.fixes[i].position.longitude_deg, b.fixes[i].position.longitude_deg);
    EXPECT_EQ(a.fixes[i].covariance_m2, b.fixes[i].covariance_m2);
  }
  ASSERT_EQ(a.headings.size(), b.headings.size());
  for (std::size_t i = 0; i < a.headings.size(); ++i) {
    EXPECT_EQ(a.headings[i].in_submap_rad, b.headings[i].in_submap_rad);
    EXPECT_EQ(a.headings[i].from_east_rad, b.headings[i].from_east_rad);
    EXPECT_EQ(a.headings[i].sigma_rad, b.headings[i].sigma_rad);
  }
}

struct SubmapInTiles : ::testing::Test {
  testing::Random random{1};
  flow::Submap submap = testing::submap(random, 3, 300, 200, 1000);
  std::vector<KeptTile> tiles = tiles_of(submap);
  SubmapAssembler assembler;

  /// What comes out of the assembler for these tiles, which must be no more than one submap.
  std::optional<flow::Submap> assemble(std::vector<KeptTile>& some) {
    std::optional<flow::Submap> result;
    for (KeptTile& tile : some) {
      auto added = assembler.add(tile.shown());
      EXPECT_EQ(added.fault, "");
      if (!added.submap) continue;
      EXPECT_FALSE(result.has_value());
      result = std::move(added.submap);
    }
    return result;
  }
};

TEST_F(SubmapInTiles, ComesBackAsItWas) {
  EXPECT_EQ(tiles.size(), 6U);
  const auto back = assemble(tiles);
  ASSERT_TRUE(back.has_value());
  expect_same(*back, submap);
  EXPECT_EQ(assembler.incomplete(), 0U);
}

TEST_F(SubmapInTiles, ComesBackFromTilesInAnyOrder) {
  std::shuffle(tiles.begin(), tiles.end(), random);
  const auto back = assemble(tiles);
  ASSERT_TRUE(back.has_value());
  expect_same(*back, submap);
}

TEST_F(SubmapInTiles, ComesOnceWhereTilesComeTwice) {
  std::vector<KeptTile> twice = tiles;
  twice.insert(twice.end(), tiles.begin(), tiles.end());
  std::shuffle(twice.begin(), twice.end(), random);
  const auto back = assemble(twice);
  ASSERT_TRUE(back.has_value());
  expect_same(*back, submap);
  EXPECT_EQ(assembler.counters().repeated_tiles, 6U);
}

TEST_F(SubmapInTiles, DoesNotComeWhereATileIsMissing) {
  tiles.pop_back();
  EXPECT_FALSE(assemble(tiles).has_value());
  EXPECT_EQ(assembler.incomplete(), 1U);
}

TEST_F(SubmapInTiles, IsNotMixedUpWithOthersThatComeAtTheSameTime) {
  std::vector<flow::Submap> submaps;
  std::vector<KeptTile> all;
  for (std::uint32_t id = 0; id < 5; ++id) {
    submaps.push_back(testing::submap(random, id, 200 + 50 * id, 150, 100 * id));
    const auto of_one = tiles_of(submaps.back());
    all.insert(all.end(), of_one.begin(), of_one.end());
  }
  std::shuffle(all.begin(), all.end(), random);
  std::size_t complete = 0;
  for (KeptTile& tile : all) {
    const auto added = assembler.add(tile.shown());
    if (!added.submap) continue;
    ++complete;
    expect_same(*added.submap, submaps.at(added.submap->submap_id.value));
  }
  EXPECT_EQ(complete, 5U);
}

TEST_F(SubmapInTiles, ComesAgainWhenItHasChanged) {
  ASSERT_TRUE(assemble(tiles).has_value());
  submap.so_log_odds[17] = static_cast<std::int8_t>(submap.so_log_odds[17] + 1);
  auto changed = tiles_of(submap);
  const auto back = assemble(changed);
  ASSERT_TRUE(back.has_value());
  expect_same(*back, submap);
}

TEST_F(SubmapInTiles, IsReplacedByANewVersionBeforeItIsComplete) {
  std::vector<KeptTile> first_half(tiles.begin(), tiles.begin() + 3);
  EXPECT_FALSE(assemble(first_half).has_value());
  submap.travelled_m += 1.0;
  auto changed = tiles_of(submap);
  const auto back = assemble(changed);
  ASSERT_TRUE(back.has_value());
  expect_same(*back, submap);
  EXPECT_EQ(assembler.counters().replaced_submaps, 1U);
}

TEST_F(SubmapInTiles, LeavesOutWhereNothingWasSeen) {
  std::fill(submap.so_log_odds.begin(), submap.so_log_odds.end(), std::int8_t{0});
  std::fill(submap.mo_evidence.begin(), submap.mo_evidence.end(), std::uint8_t{0});
  submap.mo_evidence[199 * 300 + 299] = 1;
  auto sparse = tiles_of(submap);
  EXPECT_EQ(sparse.size(), 1U);
  const auto back = assemble(sparse);
  ASSERT_TRUE(back.has_value());
  expect_same(*back, submap);
}

TEST_F(SubmapInTiles, MayBeEmpty) {
  submap = flow::Submap{};
  submap.cell_size_m = 0.1;
  auto nothing = tiles_of(submap);
  EXPECT_EQ(nothing.size(), 1U);
  const auto back = assemble(nothing);
  ASSERT_TRUE(back.has_value());
  expect_same(*back, submap);
}

TEST_F(SubmapInTiles, MayHaveMoreSurfelsThanItsCellsTakeTiles) {
  submap = testing::submap(random, 3, 20, 20, 20'000);
  auto dense = tiles_of(submap);
  EXPECT_EQ(dense.size(), 5U);
  const auto back = assemble(dense);
  ASSERT_TRUE(back.has_value());
  expect_same(*back, submap);
}

TEST_F(SubmapInTiles, AreRefusedWhereTheyAreUnsound) {
  const auto fault_after = [&](auto corrupt) {
    KeptTile corrupted = tiles[4];
    corrupt(corrupted.shown());
    return SubmapAssembler().add(corrupted.sample).fault;
  };
  EXPECT_EQ(fault_after([](auto&) {}), "");
  EXPECT_NE(fault_after([](auto& s) { s.header.odom_from_submap.x_m = kNan; }), "");
  EXPECT_NE(fault_after([](auto& s) { s.header.previous_from_submap.covariance[8] = -1.0; }), "");
  EXPECT_NE(fault_after([](auto& s) { s.header.submap_from_base_at_end.x_m = kNan; }), "");
  EXPECT_NE(fault_after([](auto& s) { s.header.travelled_m = kNan; }), "");
  EXPECT_NE(fault_after([](auto& s) { s.header.cell_size_m = 0.0; }), "");
  EXPECT_NE(fault_after([](auto& s) { s.header.min_x_m = kNan; }), "");
  EXPECT_NE(fault_after([](auto& s) { s.header.saliency = kNan; }), "");
  EXPECT_NE(fault_after([](auto& s) { s.header.column_count = s.header.row_count = 1U << 20; }),
            "");
  EXPECT_NE(fault_after([](auto& s) { s.header.surfel_count = kMostSurfels + 1; }), "");
  EXPECT_NE(fault_after([](auto& s) { s.header.tile_count = 0; }), "");
  EXPECT_NE(fault_after([](auto& s) { s.header.tile_count = 7; }), "");
  EXPECT_NE(fault_after([](auto& s) { s.tile_index = 6; }), "");
  EXPECT_NE(fault_after([](auto& s) { s.column_count = 129; }), "");
  EXPECT_NE(fault_after([](auto& s) { s.first_column = 0xFFFFFFFF; }), "");
  EXPECT_NE(fault_after([](auto& s) { s.first_row = 199; }), "");
  EXPECT_NE(fault_after([](auto& s) { --s.so_log_odds_plus_128._length; }), "");
  EXPECT_NE(fault_after([](auto& s) { --s.mo_evidence._length; }), "");
  EXPECT_NE(fault_after([](auto& s) { s.first_surfel = 0xFFFFFFFF; }), "");
  EXPECT_NE(fault_after([](auto& s) { s.surfels._buffer[0].weight = kNanF; }), "");
}

TEST_F(SubmapInTiles, AreRefusedWhereTheirHeadersDisagree) {
  ASSERT_EQ(assembler.add(tiles[0].shown()).fault, "");
  for (auto corrupt : {+[](slammot_SubmapHeader& h) { h.column_count = 299; },
                       +[](slammot_SubmapHeader& h) { h.row_count = 199; },
                       +[](slammot_SubmapHeader& h) { h.surfel_count = 999; },
                       +[](slammot_SubmapHeader& h) { h.tile_count = 5; }}) {
    KeptTile other = tiles[1];
    corrupt(other.shown().header);
    EXPECT_NE(assembler.add(other.sample).fault, "");
  }
}

TEST_F(SubmapInTiles, AreRefusedWhereTheyDoNotAddUp) {
  tiles[2].so[5] = static_cast<std::uint8_t>(tiles[2].so[5] + 1);
  std::string_view fault;
  for (KeptTile& tile : tiles) fault = assembler.add(tile.shown()).fault;
  EXPECT_NE(fault, "");
  EXPECT_EQ(assembler.incomplete(), 0U);
}

TEST_F(SubmapInTiles, AreNotMadeFromWhatIsNoSubmap) {
  const auto ignore = [](const slammot_SubmapTile&) {};
  submap.so_log_odds.pop_back();
  EXPECT_THROW(SubmapEncoder().encode("car", submap, ignore), std::invalid_argument);
  submap.columns = submap.rows = 5000;
  EXPECT_THROW(SubmapEncoder().encode("car", submap, ignore), std::length_error);
}

}  // namespace
}  // namespace slammot::wire
