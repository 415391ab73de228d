#include "services/slammot/side_thread.hpp"

#include <algorithm>
#include <atomic>
#include <functional>
#include <thread>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

namespace slammot {
namespace {

std::function<bool()> once(std::function<void()> work) {
  return [work = std::move(work)] {
    work();
    return false;
  };
}

TEST(SideThread, CompletesBegunWorkOnWait) {
  SideThread side;
  std::vector<int> done;  // not locked: wait() orders the accesses
  for (int i = 0; i < 5000; ++i) {
    side.begin(once([&done, i] { done.push_back(i); }));
    side.wait();
    ASSERT_EQ(done.size(), static_cast<std::size_t>(i) + 1);
  }
}

TEST(SideThread, WorksInOrder) {
  std::vector<int> done;
  {
    SideThread side;
    for (int i = 0; i < 5000; ++i) side.begin(once([&done, i] { done.push_back(i); }));
  }  // the destructor completes all work
  ASSERT_EQ(done.size(), 5000U);
  for (int i = 0; i < 5000; ++i) ASSERT_EQ(done[static_cast<std::size_t>(i)], i);
}

TEST(SideThread, WorksInParallelWithTheCaller) {
  SideThread side;
  std::atomic<bool> is_at_work = false;
  std::atomic<bool> may_end = false;
  std::thread::id at_work;
  side.begin(once([&] {
    at_work = std::this_thread::get_id();
    is_at_work = true;
    is_at_work.notify_one();
    may_end.wait(false);
  }));
  is_at_work.wait(false);  // hangs if the waiting caller did the work
  may_end = true;
  may_end.notify_one();
  side.wait();
  EXPECT_NE(at_work, std::this_thread::get_id());
}

TEST(SideThread, WakesAfterAPause) {
  SideThread side;
  for (int i = 0; i < 3; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(5));  // longer than the thread spins
    std::atomic<bool> is_done = false;
    side.begin(once([&] {
      is_done = true;
      is_done.notify_one();
    }));
    is_done.wait(false);  // not SideThread::wait(), which would do the work here
    side.wait();
    EXPECT_TRUE(is_done);
  }
}

TEST(SideThread, RepeatsStepsUntilTheLast) {
  SideThread side;
  for (int i = 0; i < 1000; ++i) {
    int steps = 0;
    side.begin([&steps] { return ++steps < 5; });
    side.wait();
    ASSERT_EQ(steps, 5);
  }
}

TEST(SideThread, AcceptsMoreWorksThanPlaces) {
  SideThread side;
  std::atomic<bool> may_end = false;
  std::vector<int> done;
  std::jthread lets_it_end([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    may_end = true;
    may_end.notify_all();
  });
  side.begin(once([&] { may_end.wait(false); }));
  for (int i = 0; i < 100; ++i) side.begin(once([&done, i] { done.push_back(i); }));
  side.wait();
  ASSERT_EQ(done.size(), 100U);
  EXPECT_TRUE(std::ranges::is_sorted(done));
}

TEST(SideThread, DoesEachSharedPartOnce) {
  SideThread side;
  for (std::size_t i = 0; i < 5000; ++i) {
    std::vector<int> done(i % 9, 0);  // not locked: share() orders the accesses
    side.share(done.size(), [&done](std::size_t part) { ++done[part]; });
    ASSERT_TRUE(std::ranges::all_of(done, [](int times) { return times == 1; })) << i;
  }
}

TEST(SideThread, SharesPartsWithTheCaller) {
  if (std::thread::hardware_concurrency() == 1)
    GTEST_SKIP() << "with one core the caller does everything";
  SideThread side;
  std::atomic<int> at_work = 0;
  side.share(2, [&at_work](std::size_t) {
    ++at_work;
    at_work.notify_all();
    for (int now = at_work; now < 2; now = at_work)
      at_work.wait(now);  // hangs if one thread did both
  });
  EXPECT_EQ(at_work, 2);
}

TEST(SideThread, DoesSharedPartsBetweenTwoSteps) {
  if (std::thread::hardware_concurrency() == 1)
    GTEST_SKIP() << "with one core the caller does everything";
  SideThread side;
  std::atomic<bool> is_at_work = false;
  std::atomic<bool> may_end = false;
  side.begin([&] {
    is_at_work = true;
    is_at_work.notify_one();
    return !may_end;
  });
  is_at_work.wait(false);
  std::atomic<int> at_work = 0;
  side.share(2, [&at_work](std::size_t) {
    ++at_work;
    at_work.notify_all();
    for (int now = at_work; now < 2; now = at_work) at_work.wait(now);
  });
  may_end = true;
  side.wait();
  EXPECT_EQ(at_work, 2);
}

TEST(SideThread, DoesNotDelaySharedPartsForACurrentStep) {
  SideThread side;
  std::atomic<bool> is_at_work = false;
  std::atomic<bool> may_end = false;
  side.begin(once([&] {
    is_at_work = true;
    is_at_work.notify_one();
    may_end.wait(false);
  }));
  is_at_work.wait(false);
  int done = 0;
  side.share(3, [&done](std::size_t) { ++done; });  // hangs if it waited
  EXPECT_EQ(done, 3);
  may_end = true;
  may_end.notify_one();
  side.wait();
}

TEST(SideThread, ReturnsAtOnceWithoutWork) {
  SideThread side;
  side.wait();
  side.wait();
  bool is_done = false;
  side.begin(once([&] { is_done = true; }));
  side.wait();
  EXPECT_TRUE(is_done);
}

}  // namespace
}  // namespace slammot
