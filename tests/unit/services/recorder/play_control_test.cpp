#include "services/recorder/play_control.hpp"

#include <thread>

#include <gtest/gtest.h>

namespace slammot::recorder {
namespace {

using Turn = PlayControl::Turn;

constexpr std::int64_t kSecondNs = 1'000'000'000;

PlayControl as_fast_as_possible() { return {*app::Pace::parse("max"), 0.0}; }

TEST(PlayControl, PlaysAtOnceWithoutALimit) {
  PlayControl control = as_fast_as_possible();
  EXPECT_EQ(control.await(5 * kSecondNs), Turn::kPlay);
  EXPECT_EQ(control.state().position_ns, 5 * kSecondNs);
}

TEST(PlayControl, PlaysAStepWhilePaused) {
  PlayControl control = as_fast_as_possible();
  EXPECT_EQ(control.await(0), Turn::kPlay);
  control.step(kSecondNs);
  EXPECT_EQ(control.await(kSecondNs / 2), Turn::kPlay);
  EXPECT_EQ(control.await(kSecondNs), Turn::kPlay);
  EXPECT_TRUE(control.state().is_paused);
  std::jthread other([&] { control.go_on(); });
  EXPECT_EQ(control.await(2 * kSecondNs), Turn::kPlay);
  EXPECT_FALSE(control.state().is_paused);
}

TEST(PlayControl, WaitsWhilePausedUntilItIsStopped) {
  PlayControl control = as_fast_as_possible();
  control.pause();
  std::jthread other([&] { control.stop(); });
  EXPECT_EQ(control.await(0), Turn::kStop);
  EXPECT_TRUE(control.is_stopped());
}

TEST(PlayControl, ShowsTheFirstMomentAfterASeekWhilePaused) {
  PlayControl control = as_fast_as_possible();
  control.pause();
  control.seek(7 * kSecondNs);
  EXPECT_EQ(control.await(0), Turn::kSeek);
  EXPECT_EQ(control.take_seek(), 7 * kSecondNs);
  EXPECT_EQ(control.await(7 * kSecondNs + 1), Turn::kPlay);
  control.seek(3 * kSecondNs);
  EXPECT_EQ(control.await_command(), Turn::kSeek);
}

TEST(PlayControl, ComesBackFromAWaitWhenTheSpeedChanges) {
  PlayControl control(*app::Pace::parse("0.01"), 0.01);
  EXPECT_EQ(control.await(0), Turn::kPlay);
  std::jthread other([&] { control.set_speed(*app::Pace::parse("max"), 0.0); });
  EXPECT_EQ(control.await(kSecondNs), Turn::kPlay);
}

}  // namespace
}  // namespace slammot::recorder
