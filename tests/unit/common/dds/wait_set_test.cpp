#include "common/dds/wait_set.hpp"

#include <thread>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/dds/writer.hpp"
#include "tests/support/dds.hpp"

namespace slammot::dds {
namespace {

using namespace std::chrono_literals;
using slammot::testing::assign;
using slammot::testing::kForever;
using slammot::testing::PrivateBus;

struct WaitSetOnTheBus : ::testing::Test {
  PrivateBus bus;
  Participant participant = bus.join();
  Writer<slammot_Odometry> writer{participant, topics::kOdometry};
  Reader<slammot_Odometry> reader{participant, topics::kOdometry};
  WaitSet wait_set{participant};
  std::vector<std::int64_t> stamps;

  void write(std::int64_t stamp_ns) {
    slammot_Odometry sample{};
    assign(sample.vehicle_id, "car");
    sample.stamp_ns = stamp_ns;
    writer.write(sample);
  }

  void handle_one_take() {
    const Loan<slammot_Odometry> loan = reader.take();
    for (std::size_t i = 0; i < loan.size(); ++i) stamps.push_back(loan[i].stamp_ns);
  }
};

TEST_F(WaitSetOnTheBus, WakesForDataAndHandlesItInTheWaitingThread) {
  std::thread::id handled_in;
  wait_set.on_data(reader, [&] {
    handle_one_take();
    handled_in = std::this_thread::get_id();
  });
  std::thread other([&] { write(7); });
  EXPECT_EQ(wait_set.wait(kForever), WaitSet::Wake::kHandled);
  other.join();
  EXPECT_THAT(stamps, ::testing::ElementsAre(7));
  EXPECT_EQ(handled_in, std::this_thread::get_id());
}

TEST_F(WaitSetOnTheBus, SaysThatNothingCame) {
  wait_set.on_data(reader, [&] { handle_one_take(); });
  EXPECT_EQ(wait_set.wait(1ms), WaitSet::Wake::kTimedOut);
}

TEST_F(WaitSetOnTheBus, WakesAgainForWhatAHandlerLeftBehind) {
  wait_set.on_data(reader, [&] {
    // Two readers' worth: one take gives at most LoanBase::kMost samples, and this topic keeps 20 a
    // key.
    handle_one_take();
  });
  slammot_Odometry sample{};
  for (const char* vehicle : {"a", "b", "c"}) {
    assign(sample.vehicle_id, vehicle);
    for (sample.stamp_ns = 0; sample.stamp_ns < 20; ++sample.stamp_ns) writer.write(sample);
  }
  while (stamps.size() < 60 && wait_set.wait(kForever) == WaitSet::Wake::kHandled) {}
  EXPECT_EQ(stamps.size(), 60U);
}

TEST_F(WaitSetOnTheBus, GathersWhatComesSoonAfter) {
  wait_set.on_data(reader, [&] { handle_one_take(); });
  wait_set.gather_for(500ms);
  write(1);
  std::thread other([&] {
    std::this_thread::sleep_for(5ms);
    write(2);
  });
  EXPECT_EQ(wait_set.wait(kForever), WaitSet::Wake::kHandled);
  other.join();
  EXPECT_THAT(stamps, ::testing::ElementsAre(1, 2));
}

TEST_F(WaitSetOnTheBus, StopsFromAnotherThreadForGood) {
  wait_set.on_data(reader, [&] { handle_one_take(); });
  std::thread other([&] { wait_set.stop(); });
  EXPECT_EQ(wait_set.wait(kForever), WaitSet::Wake::kStopped);
  other.join();
  write(1);
  EXPECT_EQ(wait_set.wait(kForever), WaitSet::Wake::kStopped);
  EXPECT_TRUE(stamps.empty());
}

}  // namespace
}  // namespace slammot::dds
