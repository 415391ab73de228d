#include "services/localization/waiting_scans.hpp"

#include <gtest/gtest.h>

namespace slammot::localization {
namespace {

constexpr Awaited kNothing{.has_odometry = true};
constexpr Awaited kOdometry{.has_odometry = false};
constexpr Awaited kLabels{.has_odometry = true, .awaits_labels = true};

WaitingScan scan_of(std::uint64_t drive_id) { return {{}, drive_id}; }

/// Turns until the oldest scan may begin.
int turns_until_it_begins(WaitingScans& waiting, const Awaited& awaited) {
  int turns = 0;
  for (; !waiting.may_begin(awaited); ++turns) waiting.count_turn();
  return turns;
}

TEST(WaitingScans, BeginInTheOrderOfArrivalWhereNothingIsAwaited) {
  WaitingScans waiting;
  waiting.add(scan_of(1));
  waiting.add(scan_of(2));
  ASSERT_TRUE(waiting.may_begin(kNothing));
  EXPECT_EQ(waiting.take(kNothing).drive_id, 1U);
  EXPECT_EQ(waiting.take(kNothing).drive_id, 2U);
  EXPECT_TRUE(waiting.empty());
}

TEST(WaitingScans, AwaitOdometryForSomeTurnsAndTheFirstForMore) {
  WaitingScans waiting;
  waiting.add(scan_of(1));
  const int turns = turns_until_it_begins(waiting, kOdometry);
  EXPECT_GT(turns, 1);
  WaitingScans first;
  first.add(scan_of(1));
  EXPECT_GT(turns_until_it_begins(first, {.has_odometry = false, .is_first = true}), 5 * turns);
}

TEST(WaitingScans, AwaitOdometryNoMoreAfterSeveralDidInVainUntilItComesAgain) {
  WaitingScans waiting;
  for (int i = 0; i < 3; ++i) {
    waiting.add(scan_of(1));
    EXPECT_FALSE(waiting.may_begin(kOdometry)) << i;
    waiting.take(kOdometry);
  }
  waiting.add(scan_of(1));
  EXPECT_TRUE(waiting.may_begin(kOdometry));
  waiting.note_odometry();
  EXPECT_FALSE(waiting.may_begin(kOdometry));
}

TEST(WaitingScans, AwaitTrackingForSomeTurnsUnlessTheyQueueUpAndAfterARestartAlsoThen) {
  WaitingScans waiting;
  waiting.add(scan_of(1));
  const int turns = turns_until_it_begins(waiting, kLabels);
  WaitingScans queue;
  queue.add(scan_of(1));
  queue.add(scan_of(1));
  EXPECT_TRUE(queue.may_begin(kLabels));
  const int turns_in_queue =
      turns_until_it_begins(queue, {.has_odometry = true, .awaits_labels = true, .is_back = true});
  EXPECT_GT(turns_in_queue, 1);
  EXPECT_GT(turns, 3 * turns_in_queue);
}

TEST(WaitingScans, AwaitForAFewTurnsWhatTrackingSaidBeforeARestart) {
  WaitingScans waiting;
  waiting.add(scan_of(1));
  const int turns = turns_until_it_begins(waiting, {.has_odometry = true, .awaits_history = true});
  EXPECT_GT(turns, 1);
  EXPECT_LE(turns, 5);
}

TEST(WaitingScans, AwaitTheObjectsOfTheNewestLabels) {
  WaitingScans waiting;
  waiting.add(scan_of(1));
  waiting.note_labels(100, false);
  EXPECT_FALSE(waiting.may_begin(kNothing));
  waiting.note_objects(100, false);
  EXPECT_TRUE(waiting.may_begin(kNothing));
}

TEST(WaitingScans, AwaitTheObjectsOfEachOfTwoScansWithOneStamp) {
  WaitingScans waiting;
  for (int scanner = 0; scanner < 2; ++scanner) {
    waiting.add(scan_of(1));
    waiting.note_labels(100, false);
    EXPECT_FALSE(waiting.may_begin(kNothing)) << scanner;
    waiting.note_objects(100, false);
    EXPECT_TRUE(waiting.may_begin(kNothing)) << scanner;
    waiting.take(kNothing);
  }
}

TEST(WaitingScans, AwaitTrackingNoMoreWhileItIsLate) {
  WaitingScans waiting;
  for (int i = 0; i < 3; ++i) {
    waiting.add(scan_of(1));
    EXPECT_FALSE(waiting.may_begin(kLabels)) << i;
    waiting.take(kLabels);
  }
  waiting.add(scan_of(1));
  EXPECT_TRUE(waiting.may_begin(kLabels));
  waiting.note_objects(100, false);
  EXPECT_FALSE(waiting.may_begin(kLabels)) << "it has caught up";
}

}  // namespace
}  // namespace slammot::localization
