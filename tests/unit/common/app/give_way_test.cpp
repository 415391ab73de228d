#include "common/app/give_way.hpp"

#include <sched.h>
#include <sys/resource.h>
#include <unistd.h>

#include <thread>

#include <gtest/gtest.h>

namespace slammot::app {
namespace {

struct Scheduling {
  int policy = ::sched_getscheduler(0);
  int nice = ::getpriority(PRIO_PROCESS, static_cast<id_t>(::gettid()));
};

TEST(GiveWay, HoldsForTheThreadAndThoseThatItStarts) {
  Scheduling own, of_child;
  std::thread([&] {
    give_way();
    own = Scheduling();
    std::thread([&] { of_child = Scheduling(); }).join();
  }).join();
  EXPECT_EQ(own.policy, SCHED_BATCH);
  EXPECT_EQ(own.nice, 4);
  EXPECT_EQ(of_child.policy, SCHED_BATCH);
  EXPECT_EQ(of_child.nice, 4);
}

TEST(GiveWay, LeavesOtherThreadsAlone) {
  const Scheduling before;
  std::thread(give_way).join();
  const Scheduling after;
  EXPECT_EQ(after.policy, before.policy);
  EXPECT_EQ(after.nice, before.nice);
}

}  // namespace
}  // namespace slammot::app
