#include "services/ingest/graph_watch.hpp"

#include <gtest/gtest.h>

namespace slammot::ingest {
namespace {

using namespace std::chrono_literals;

const GraphWatch::Time kStart{100s};
constexpr flow::MapId kMap{7};

GraphWatch watch_with_finished_submap() {
  GraphWatch watch(5s);
  watch.heard(kStart);
  watch.set_current(kMap, 1, kStart);
  return watch;
}

TEST(GraphWatch, IsNotBehindInTheFirstSubmap) {
  GraphWatch watch(5s);
  watch.heard(kStart);
  watch.set_current(kMap, 0, kStart);
  EXPECT_FALSE(watch.is_behind(kStart));
}

TEST(GraphWatch, IsBehindUntilTheFinishedSubmapIsPlaced) {
  GraphWatch watch = watch_with_finished_submap();
  EXPECT_TRUE(watch.is_behind(kStart + 1s));
  watch.set_placed(kMap, 0);
  EXPECT_FALSE(watch.is_behind(kStart + 1s));
  watch.set_current(kMap, 2, kStart + 1s);
  EXPECT_TRUE(watch.is_behind(kStart + 1s));
}

TEST(GraphWatch, IgnoresTheGraphOfAnotherMap) {
  GraphWatch watch = watch_with_finished_submap();
  watch.set_placed({6}, 5);
  EXPECT_TRUE(watch.is_behind(kStart + 1s));
}

TEST(GraphWatch, StopsWaitingAfterItsPatience) {
  GraphWatch watch = watch_with_finished_submap();
  watch.heard(kStart + 5s);
  EXPECT_FALSE(watch.is_behind(kStart + 5s));
}

TEST(GraphWatch, WaitsForALoopClosingThatIsBusyAndSilent) {
  const GraphWatch watch = watch_with_finished_submap();
  EXPECT_TRUE(watch.is_behind(kStart + 4s));
}

TEST(GraphWatch, DoesNotWaitForAnAbsentLoopClosing) {
  GraphWatch unheard(5s);
  unheard.set_current(kMap, 1, kStart);
  EXPECT_FALSE(unheard.is_behind(kStart));
  GraphWatch gone = watch_with_finished_submap();
  gone.set_current(kMap, 2, kStart + 5s);
  EXPECT_FALSE(gone.is_behind(kStart + 5s)) << "once is enough";
}

}  // namespace
}  // namespace slammot::ingest
