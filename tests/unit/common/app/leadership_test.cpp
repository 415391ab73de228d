#include "common/app/leadership.hpp"

#include <gtest/gtest.h>

namespace slammot::app {
namespace {

using namespace std::chrono_literals;
using Role = Leadership::Role;

constexpr SteadyTime kStart{std::chrono::hours(1)};

/// Processes that hear each other's heartbeats every 50 ms, each by way of `hears`.
struct Processes {
  struct Process {
    Leadership::Identity identity;
    Leadership leadership;
    bool is_alive = true;
    wire::ServiceState state = wire::ServiceState::kRunning;
  };
  std::vector<Process> all;
  SteadyTime now = kStart;
  std::function<bool(std::size_t from, std::size_t to)> hears = [](auto, auto) { return true; };
  int most_leading = 0;

  std::size_t start(std::int64_t started_ns, const std::string& instance = "main") {
    const Leadership::Identity identity{started_ns, 100, instance};
    all.push_back({identity, Leadership(identity, now)});
    return all.size() - 1;
  }
  Role role(std::size_t index) const { return all[index].leadership.role(now); }
  int leading() const {
    int count = 0;
    for (std::size_t i = 0; i < all.size(); ++i)
      count += all[i].is_alive && role(i) == Role::kLeads;
    return count;
  }
  wire::Heartbeat beat_of(const Process& process) const {
    wire::Heartbeat beat;
    beat.name.instance = process.identity.instance;
    beat.process_number = process.identity.process_number;
    beat.started_ns = process.identity.started_ns;
    beat.state = process.state;
    beat.term = process.leadership.term();
    beat.stands_by = beat.term == 0;
    return beat;
  }
  void pass(std::chrono::milliseconds time) {
    for (const SteadyTime end = now + time; now < end; now += 50ms) {
      for (std::size_t from = 0; from < all.size(); ++from) {
        if (!all[from].is_alive) continue;
        if (role(from) == Role::kMayLead) all[from].leadership.lead();
        if (role(from) == Role::kSteppedDown) all[from].is_alive = false;
        for (std::size_t to = 0; to < all.size(); ++to)
          if (hears(from, to)) all[to].leadership.heard(beat_of(all[from]), now);
      }
      most_leading = std::max(most_leading, leading());
    }
  }
};

TEST(Leadership, IsTakenByAProcessThatIsAlone) {
  Processes processes;
  const auto one = processes.start(1);
  EXPECT_EQ(processes.role(one), Role::kUndecided);
  processes.pass(300ms);
  EXPECT_EQ(processes.role(one), Role::kLeads);
}

TEST(Leadership, StaysWithTheFirstAlsoIfTheClockOfTheSecondIsBehind) {
  Processes processes;
  const auto first = processes.start(1'000);
  processes.pass(300ms);
  const auto second = processes.start(1);
  processes.pass(2s);
  EXPECT_EQ(processes.role(first), Role::kLeads);
  EXPECT_EQ(processes.role(second), Role::kStandsBy);
  EXPECT_EQ(processes.most_leading, 1);
}

TEST(Leadership, IsTakenByOneOfSeveralThatStartAtTheSameTime) {
  Processes processes;
  for (int i = 0; i < 5; ++i) processes.start(7, "copy" + std::to_string(i));
  processes.pass(2s);
  EXPECT_EQ(processes.leading(), 1);
  EXPECT_EQ(processes.most_leading, 1);
}

TEST(Leadership, GoesToOneStandbyWithin300MsOfTheDeathOfTheLeader) {
  Processes processes;
  const auto leader = processes.start(1);
  processes.pass(300ms);
  const auto second = processes.start(2), third = processes.start(3);
  processes.pass(1s);
  processes.all[leader].is_alive = false;
  processes.pass(300ms);
  EXPECT_EQ(processes.role(second), Role::kLeads);
  EXPECT_EQ(processes.all[second].leadership.term(), 2U);
  processes.pass(1s);
  EXPECT_EQ(processes.role(third), Role::kStandsBy);
  EXPECT_EQ(processes.most_leading, 1);
}

TEST(Leadership, IsHandedOverWithin50MsByALeaderThatStops) {
  Processes processes;
  const auto leader = processes.start(1);
  processes.pass(300ms);
  const auto second = processes.start(2);
  processes.pass(1s);
  processes.all[leader].state = wire::ServiceState::kStopping;
  processes.pass(50ms);
  processes.all[leader].is_alive = false;
  processes.pass(50ms);
  EXPECT_EQ(processes.role(second), Role::kLeads);
}

TEST(Leadership, IsGivenUpByAHungProcessThatWakesUpAfterItWasReplaced) {
  Processes processes;
  const auto hung = processes.start(1);
  processes.pass(300ms);
  const auto second = processes.start(2);
  processes.pass(1s);
  processes.all[hung].is_alive = false;
  processes.pass(1s);
  processes.all[hung].is_alive = true;
  processes.pass(100ms);
  EXPECT_FALSE(processes.all[hung].is_alive);
  EXPECT_EQ(processes.role(second), Role::kLeads);
}

TEST(Leadership, IsWithOneOfTwoAgainAfterTheNetworkWasCut) {
  Processes processes;
  const auto first = processes.start(1);
  processes.pass(300ms);
  const auto second = processes.start(2);
  processes.pass(1s);
  processes.hears = [](auto, auto) { return false; };
  processes.pass(1s);
  EXPECT_EQ(processes.role(second), Role::kLeads) << "each side of the cut has a leader";
  processes.hears = [](auto, auto) { return true; };
  processes.pass(200ms);
  EXPECT_EQ(processes.leading(), 1);
  EXPECT_FALSE(processes.all[first].is_alive);
}

}  // namespace
}  // namespace slammot::app
