#include "services/gateway/service_board.hpp"

#include <gtest/gtest.h>

namespace slammot::gateway {
namespace {

using namespace std::chrono_literals;

const ServiceBoard::Time kStart{1000s};

wire::Heartbeat beat_of(const std::string& instance, std::int64_t started_ns) {
  wire::Heartbeat beat;
  beat.name.service = "tracking";
  beat.name.instance = instance;
  beat.process_number = 1;  // as in every container
  beat.state = wire::ServiceState::kRunning;
  beat.started_ns = started_ns;
  return beat;
}

TEST(ServiceBoard, WarnsOfAServiceThatFellSilent) {
  ServiceBoard board;
  board.take(beat_of("main", 5), kStart);
  EXPECT_TRUE(board.warnings(kStart).empty());
  EXPECT_EQ(board.warnings(kStart + 10s).size(), 1U);
}

TEST(ServiceBoard, KnowsAStandbyThatLeadsByItsNewNameOnly) {
  ServiceBoard board;
  board.take(beat_of("main (standby)", 5), kStart);
  board.take(beat_of("main", 5), kStart + 10s);
  ASSERT_EQ(board.entries().size(), 1U);
  EXPECT_EQ(board.entries().front().instance, "main");
  EXPECT_TRUE(board.warnings(kStart + 10s).empty());
}

TEST(ServiceBoard, KeepsAStandbyBesideItsLeader) {
  ServiceBoard board;
  board.take(beat_of("main (standby)", 7), kStart);
  board.take(beat_of("main", 5), kStart);
  EXPECT_EQ(board.entries().size(), 2U);
}

}  // namespace
}  // namespace slammot::gateway
