#include "services/ingest/scan_window.hpp"

#include <gtest/gtest.h>

namespace slammot::ingest {
namespace {

using namespace std::chrono_literals;

const ScanWindow::Time kStart{100s};

TEST(ScanWindow, HasRoomUntilItIsFull) {
  ScanWindow window({2, 1s});
  EXPECT_TRUE(window.is_empty());
  window.sent(10, kStart);
  EXPECT_TRUE(window.has_room());
  window.sent(20, kStart);
  EXPECT_FALSE(window.has_room());
}

TEST(ScanWindow, HasRoomAgainAfterAnAnswer) {
  ScanWindow window({1, 1s});
  window.sent(10, kStart);
  EXPECT_EQ(window.acknowledge(10, kStart), 1U);
  EXPECT_TRUE(window.has_room());
}

TEST(ScanWindow, AcknowledgesCumulatively) {
  ScanWindow window({3, 1s});
  for (const std::int64_t stamp : {10, 20, 30}) window.sent(stamp, kStart);
  EXPECT_EQ(window.acknowledge(25, kStart), 2U);
  EXPECT_EQ(window.acknowledge(25, kStart), 0U);
  EXPECT_EQ(window.acknowledge(99, kStart), 1U);
}

TEST(ScanWindow, IsOverdueWithoutProgress) {
  ScanWindow window({2, 1s});
  EXPECT_FALSE(window.is_overdue(kStart + 1h));
  window.sent(10, kStart);
  EXPECT_FALSE(window.is_overdue(kStart + 999ms));
  EXPECT_TRUE(window.is_overdue(kStart + 1s));
}

TEST(ScanWindow, RestartsItsTimerOnProgressAndOnResending) {
  ScanWindow window({2, 1s});
  window.sent(10, kStart);
  window.sent(20, kStart + 500ms);
  window.acknowledge(10, kStart + 900ms);
  EXPECT_FALSE(window.is_overdue(kStart + 1800ms));
  EXPECT_TRUE(window.is_overdue(kStart + 1900ms));
  EXPECT_EQ(window.resend(kStart + 1900ms), 0U);
  EXPECT_FALSE(window.is_overdue(kStart + 2800ms));
}

TEST(ScanWindow, GivesUpUnansweredScans) {
  ScanWindow window({1, 1s, 3});
  window.sent(10, kStart);
  EXPECT_EQ(window.resend(kStart + 1s), 0U);
  EXPECT_EQ(window.resend(kStart + 2s), 0U);
  EXPECT_EQ(window.resend(kStart + 3s), 1U);
  EXPECT_TRUE(window.has_room());
}

}  // namespace
}  // namespace slammot::ingest
