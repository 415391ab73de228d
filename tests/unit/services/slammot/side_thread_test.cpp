#include "services/slammot/side_thread.hpp"

#include <atomic>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

namespace slammot {
namespace {

TEST(SideThread, HasDoneWhatWasBegunWhenItWasWaitedFor) {
  SideThread side;
  std::vector<int> done;  // no lock: waiting is what orders them
  for (int i = 0; i < 5000; ++i) {
    side.begin([&done, i] { done.push_back(i); });
    side.wait();
    ASSERT_EQ(done.size(), static_cast<std::size_t>(i) + 1);
  }
}

TEST(SideThread, DoesOneThingAfterTheOtherInTheirOrder) {
  std::vector<int> done;
  {
    SideThread side;
    for (int i = 0; i < 5000; ++i) side.begin([&done, i] { done.push_back(i); });
  }  // and all of it before it goes
  ASSERT_EQ(done.size(), 5000U);
  for (int i = 0; i < 5000; ++i) ASSERT_EQ(done[static_cast<std::size_t>(i)], i);
}

TEST(SideThread, WorksBesideItsCaller) {
  SideThread side;
  std::atomic<bool> is_at_work = false;
  std::atomic<bool> may_end = false;
  std::thread::id at_work;
  side.begin([&] {
    at_work = std::this_thread::get_id();
    is_at_work = true;
    is_at_work.notify_one();
    may_end.wait(false);
  });
  is_at_work.wait(false);  // for ever, if nobody but the waiting caller did the work
  may_end = true;
  may_end.notify_one();
  side.wait();
  EXPECT_NE(at_work, std::this_thread::get_id());
}

TEST(SideThread, WakesAgainAfterARest) {
  SideThread side;
  for (int i = 0; i < 3; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(5));  // longer than it looks out for work
    std::atomic<bool> is_done = false;
    side.begin([&] {
      is_done = true;
      is_done.notify_one();
    });
    is_done.wait(false);  // not SideThread::wait(), which would do it here
    side.wait();
  }
}

TEST(SideThread, WaitsForNothingWhereNothingWasBegun) {
  SideThread side;
  side.wait();
  side.wait();
}

}  // namespace
}  // namespace slammot
