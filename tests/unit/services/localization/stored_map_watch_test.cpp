#include "services/localization/stored_map_watch.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace slammot::localization {
namespace {

using Verdict = StoredMapWatch::Verdict;
using ::testing::HasSubstr;

constexpr std::int64_t kSecondNs = 1'000'000'000;
constexpr std::int64_t kPatienceNs = 10 * kSecondNs;
constexpr flow::MapId kMap{7};
constexpr double kCell_m = 0.2;

flow::StoredMap stored(std::uint32_t submaps) { return {kMap, submaps, 0, {submaps - 1}, kCell_m}; }

flow::GraphCorrection placed(std::uint32_t submaps, flow::MapId map_id = kMap) {
  flow::GraphCorrection correction{.sequence = submaps, .map_id = map_id};
  for (std::uint32_t id = 0; id < submaps; ++id)
    correction.submaps.push_back({{id}, {1.0 * id, 0.0, 0.0}});
  return correction;
}

struct StoredMapWatchTest : ::testing::Test {
  StoredMapWatch watch{kPatienceNs, kCell_m, 0};

  void expect_fault_of(const flow::StoredMap& map, const std::string& reason) {
    watch.is_stored(map, 0);
    const auto answer = watch.answer(0);
    EXPECT_EQ(answer.verdict, Verdict::kCannot);
    EXPECT_THAT(answer.reason, HasSubstr(reason));
  }
};

TEST_F(StoredMapWatchTest, GoesOnOnceAllThatIsStoredIsPlaced) {
  watch.is_stored(stored(3), 0);
  EXPECT_EQ(watch.answer(0).verdict, Verdict::kWait);
  watch.is_placed(placed(2), 0);
  EXPECT_EQ(watch.answer(0).verdict, Verdict::kWait);
  EXPECT_EQ(watch.answer(0).reason, "loop closing has placed 2 of 3 submaps");
  watch.is_placed(placed(3), 0);
  EXPECT_EQ(watch.answer(0).verdict, Verdict::kGoOn);
  EXPECT_EQ(watch.graph().submaps.back().submap_id, flow::SubmapId{2});
}

TEST_F(StoredMapWatchTest, DoesNotMindWhichOfBothIsHeardFirst) {
  watch.is_placed(placed(3), 0);
  watch.is_stored(stored(3), 0);
  EXPECT_EQ(watch.answer(0).verdict, Verdict::kGoOn);
}

TEST_F(StoredMapWatchTest, TakesNoNoteOfTheGraphOfAnotherMap) {
  watch.is_stored(stored(3), 0);
  watch.is_placed(placed(3, {6}), 0);
  EXPECT_EQ(watch.answer(0).verdict, Verdict::kWait);
}

TEST_F(StoredMapWatchTest, GivesUpAStoreThatIsNotThere) {
  EXPECT_EQ(watch.answer(kPatienceNs - 1).verdict, Verdict::kWait);
  EXPECT_EQ(watch.answer(kPatienceNs).verdict, Verdict::kCannot);
  EXPECT_THAT(watch.answer(kPatienceNs).reason, HasSubstr("map_store"));
}

TEST_F(StoredMapWatchTest, GivesUpALoopClosingThatStopsHalfWay) {
  watch.is_stored(stored(3), 0);
  watch.is_placed(placed(1), 8 * kSecondNs);
  EXPECT_EQ(watch.answer(17 * kSecondNs).verdict, Verdict::kWait) << "it comes on, slowly";
  EXPECT_EQ(watch.answer(18 * kSecondNs).verdict, Verdict::kCannot);
}

TEST_F(StoredMapWatchTest, KnowsAnEmptyStoreFromOneThatIsNotThere) {
  watch.is_stored({}, 0);
  EXPECT_EQ(watch.answer(0).verdict, Verdict::kNothingStored);
}

TEST_F(StoredMapWatchTest, DoesNotGoOnInAMapWithHoles) {
  expect_fault_of({kMap, 2, 0, {2}, kCell_m}, "1 of 3 submaps are missing");
  expect_fault_of({kMap, 2, 1, {2}, kCell_m}, "1 of 3 submaps are damaged");
  expect_fault_of({{}, 0, 1, {0}, 0.0}, "1 of 1 submaps are damaged");
}

TEST_F(StoredMapWatchTest, DoesNotGoOnInAMapOfAnotherProfile) {
  flow::StoredMap indoor = stored(3);
  indoor.cell_size_m = 0.05;
  expect_fault_of(indoor, "cells of 0.05 m for 0.2 m here");
}

TEST_F(StoredMapWatchTest, WaitsForTheEndOfTheDriveBefore) {
  watch.is_stored(stored(3), 0);
  watch.is_placed(placed(3), 0);
  watch.is_on_its_way(kMap, {3}, 0);
  EXPECT_EQ(watch.answer(0).verdict, Verdict::kWait);
  watch.is_stored(stored(4), 0);
  watch.is_placed(placed(4), 0);
  EXPECT_EQ(watch.answer(0).verdict, Verdict::kGoOn);
}

TEST_F(StoredMapWatchTest, WaitsForTheFirstMapOfAllToBeStored) {
  watch.is_stored({}, 0);
  watch.is_on_its_way({8}, {0}, 0);
  EXPECT_EQ(watch.answer(0).verdict, Verdict::kWait);
  EXPECT_EQ(watch.answer(kPatienceNs).verdict, Verdict::kCannot);
}

}  // namespace
}  // namespace slammot::localization
