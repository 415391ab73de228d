#include "common/app/status_board.hpp"

#include <gtest/gtest.h>

namespace slammot::app {
namespace {

using namespace std::chrono_literals;

const SteadyTime kStart{100s};

TEST(StatusBoard, RunsWhileNothingIsMissing) {
  StatusBoard board;
  board.input("slammot/laser_scan", Input::kSteady, kStart).came(kStart);
  EXPECT_EQ(board.state(kStart + 1s), ServiceState::kRunning);
  EXPECT_EQ(board.explanation(kStart + 1s), "");
}

TEST(StatusBoard, IsDegradedAndSaysByWhatWhileAnInputIsMissing) {
  StatusBoard board;
  InputWatch& scans = board.input("slammot/laser_scan", Input::kSteady, kStart);
  scans.came(kStart);
  EXPECT_EQ(board.state(kStart + 3s), ServiceState::kDegraded);
  EXPECT_EQ(board.explanation(kStart + 3s), "no slammot/laser_scan for 3.0 s");
  scans.came(kStart + 3s);
  EXPECT_EQ(board.state(kStart + 3s), ServiceState::kRunning);
}

TEST(StatusBoard, IsDegradedUntilATroubleIsCleared) {
  StatusBoard board;
  board.set_trouble("database", "disk is full");
  EXPECT_EQ(board.explanation(kStart), "disk is full");
  board.clear_trouble("database");
  EXPECT_EQ(board.state(kStart), ServiceState::kRunning);
}

TEST(StatusBoard, IsStartingForAsLongAsItSaysSoAndMaySayWhy) {
  StatusBoard board;
  board.set_starting(true);
  board.set_trouble("map", "waits for the map");
  EXPECT_EQ(board.state(kStart), ServiceState::kStarting);
  EXPECT_EQ(board.explanation(kStart), "waits for the map");
  board.set_starting(false);
  EXPECT_EQ(board.state(kStart), ServiceState::kDegraded);
}

TEST(StatusBoard, CountsFromZero) {
  StatusBoard board;
  ++board.counter("scans");
  EXPECT_EQ(board.counters().at("scans"), 1U);
}

}  // namespace
}  // namespace slammot::app
