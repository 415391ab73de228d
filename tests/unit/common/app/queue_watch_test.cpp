#include "common/app/queue_watch.hpp"

#include <gtest/gtest.h>

namespace slammot::app {
namespace {

using namespace std::chrono_literals;

const SteadyTime kStart{100s};

TEST(QueueWatch, KeepsALongQueueAfterARestart) {
  QueueWatch watch;
  for (auto at = 0ms; at <= 2000ms; at += 100ms) EXPECT_FALSE(watch.leaves_out(true, kStart + at));
}

TEST(QueueWatch, LeavesOutWhatALastingQueueHolds) {
  QueueWatch watch;
  for (auto at = 0ms; at <= 2000ms; at += 100ms) watch.leaves_out(true, kStart + at);
  EXPECT_TRUE(watch.leaves_out(true, kStart + 2100ms));
  EXPECT_FALSE(watch.leaves_out(false, kStart + 2110ms)) << "the newest are used";
  EXPECT_TRUE(watch.leaves_out(true, kStart + 2200ms)) << "the overload lasts";
}

TEST(QueueWatch, ForgetsAnOverloadThatIsOver) {
  QueueWatch watch;
  for (auto at = 0ms; at <= 3000ms; at += 100ms) watch.leaves_out(true, kStart + at);
  EXPECT_FALSE(watch.leaves_out(true, kStart + 6s));
}

}  // namespace
}  // namespace slammot::app
