#include "common/app/state_lock.hpp"

#include <sys/wait.h>
#include <unistd.h>

#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/temporary_folder.hpp"

namespace slammot::app {
namespace {

struct StateLockTest : ::testing::Test {
  slammot::testing::TemporaryFolder folder;
  std::filesystem::path path = folder / "new folder/service.lock";
};

TEST_F(StateLockTest, IsHadByOneAtATime) {
  StateLock first(path), second(path);
  EXPECT_EQ(first.try_lock(), StateLock::Outcome::kLocked);
  EXPECT_EQ(second.try_lock(), StateLock::Outcome::kInUse);
  EXPECT_EQ(second.reason(), path.string() + " is in use by process " + std::to_string(::getpid()));
}

TEST_F(StateLockTest, IsGivenBackAtTheEnd) {
  { EXPECT_EQ(StateLock(path).try_lock(), StateLock::Outcome::kLocked); }
  StateLock next(path);
  EXPECT_EQ(next.try_lock(), StateLock::Outcome::kLocked);
  EXPECT_EQ(next.reason(), "");
}

TEST_F(StateLockTest, IsReleasedToTheNextOneWhileItLives) {
  StateLock first(path), next(path);
  ASSERT_EQ(first.try_lock(), StateLock::Outcome::kLocked);
  first.release();
  EXPECT_EQ(next.try_lock(), StateLock::Outcome::kLocked);
  EXPECT_EQ(first.try_lock(), StateLock::Outcome::kInUse);
}

TEST_F(StateLockTest, NamesItsHolderAsTheSystemKnowsIt) {
  StateLock lock(path), other(path);
  EXPECT_EQ(other.holder(), std::nullopt);
  ASSERT_EQ(lock.try_lock(), StateLock::Outcome::kLocked);
  std::ofstream(path) << 1;  // what the file says does not count
  EXPECT_EQ(other.holder(), ::getpid());
  lock.release();
  EXPECT_EQ(other.holder(), std::nullopt);
}

TEST_F(StateLockTest, IsGivenBackByAProcessThatIsKilled) {
  const pid_t child = ::fork();
  if (child == 0) {
    StateLock lock(path);
    lock.try_lock();
    ::kill(::getpid(), SIGKILL);
  }
  ASSERT_EQ(::waitpid(child, nullptr, 0), child);
  StateLock next(path);
  EXPECT_EQ(next.try_lock(), StateLock::Outcome::kLocked);
}

TEST_F(StateLockTest, SaysWhyItCannotBeMade) {
  StateLock lock("/proc/no/service.lock");
  EXPECT_EQ(lock.try_lock(), StateLock::Outcome::kCannot);
  EXPECT_THAT(lock.reason(), ::testing::StartsWith("cannot lock /proc/no/service.lock: "));
}

}  // namespace
}  // namespace slammot::app
