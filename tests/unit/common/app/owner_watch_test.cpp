#include "common/app/owner_watch.hpp"

#include <gtest/gtest.h>

namespace slammot::app {
namespace {

using namespace std::chrono_literals;

constexpr SteadyTime kStart{std::chrono::hours(1)};

struct OwnerWatchTest : ::testing::Test {
  OwnerWatch watch;
  SteadyTime now = kStart;
  std::uint64_t gone = 0;  ///< A writer that no longer exists.

  bool accepts(std::uint64_t writer, std::uint64_t key = 1) {
    return watch.accepts({key, writer}, now, [this](std::uint64_t other) { return other == gone; });
  }
  void write(std::uint64_t writer, int count, std::chrono::milliseconds period = 25ms) {
    for (int i = 0; i < count; ++i, now += period) EXPECT_TRUE(accepts(writer));
  }
};

TEST_F(OwnerWatchTest, KeepsToTheWriterThatGoesOn) {
  write(1, 10);
  EXPECT_FALSE(accepts(2));
  write(1, 1);
  EXPECT_FALSE(accepts(2));
}

TEST_F(OwnerWatchTest, AcceptsAnotherOneWhenTheFirstIsGone) {
  write(1, 10);
  gone = 1;
  EXPECT_TRUE(accepts(2));
}

TEST_F(OwnerWatchTest, AcceptsAnotherOneAfterASilenceAndKeepsToIt) {
  write(1, 10);
  now += 150ms;
  EXPECT_TRUE(accepts(2));
  EXPECT_FALSE(accepts(1)) << "it woke up after it was replaced";
}

TEST_F(OwnerWatchTest, IsPatientWithARareWriter) {
  write(1, 10, 500ms);
  EXPECT_FALSE(accepts(2));
  now += 1s;
  EXPECT_TRUE(accepts(2));
}

TEST_F(OwnerWatchTest, AcceptsTheNextOneAtOnceWhenTheFirstHandsOver) {
  write(1, 10);
  watch.release(1);
  EXPECT_TRUE(accepts(2));
  EXPECT_FALSE(accepts(1));
}

TEST_F(OwnerWatchTest, LetsEveryKeyHaveItsOwnWriter) {
  EXPECT_TRUE(accepts(1, 1));
  EXPECT_TRUE(accepts(2, 2));
  EXPECT_FALSE(accepts(2, 1));
}

TEST_F(OwnerWatchTest, KnowsTheNewestOfManyKeys) {
  for (std::uint64_t key = 0; key < 5000; ++key, now += 1ms) EXPECT_TRUE(accepts(1, key));
  EXPECT_FALSE(accepts(2, 4999));
  EXPECT_TRUE(accepts(2, 0)) << "forgotten";
}

}  // namespace
}  // namespace slammot::app
