#include <array>
#include <csignal>
#include <cstdint>
#include <random>
#include <set>

#include <sys/wait.h>
#include <unistd.h>

#include <gtest/gtest.h>

#include "services/map_store/store.hpp"
#include "tests/support/example_submap.hpp"
#include "tests/support/temporary_folder.hpp"

namespace slammot::map_store {
namespace {

using slammot::testing::example_submap;
using slammot::testing::same_submap;

/// Runs in the child: stores submaps until killed and writes the number of each to the pipe after
/// put() has returned.
[[noreturn]] void write_until_killed(const std::filesystem::path& file, int acknowledge) {
  auto store = Store::open(file, {});
  if (!std::holds_alternative<Store>(store)) _exit(1);
  for (std::uint32_t id = 0;; ++id) {
    const PutResult result = std::get<Store>(store).put("car", example_submap(id));
    if (result == PutResult::kFailed) _exit(2);
    if (::write(acknowledge, &id, sizeof id) != sizeof id) _exit(3);
  }
}

struct Killed {
  std::uint32_t committed = 0;  ///< Submaps 0 to committed - 1 were acknowledged.
  int wait_status = 0;
};

/// Kills a writing child at an arbitrary time after it has acknowledged `enough` submaps.
Killed kill_while_writing(const std::filesystem::path& file, std::uint32_t enough,
                          useconds_t then_us) {
  std::array<int, 2> pipe_ends{};
  if (::pipe(pipe_ends.data()) != 0) throw std::runtime_error("no pipe");
  const pid_t child = ::fork();
  if (child == 0) write_until_killed(file, pipe_ends[1]);
  ::close(pipe_ends[1]);
  Killed killed;
  std::uint32_t id = 0;
  while (killed.committed < enough && ::read(pipe_ends[0], &id, sizeof id) == sizeof id)
    killed.committed = id + 1;
  ::usleep(then_us);  // arbitrary delay, so that each kill hits another place in a write
  ::kill(child, SIGKILL);
  while (::read(pipe_ends[0], &id, sizeof id) == sizeof id) killed.committed = id + 1;
  ::close(pipe_ends[0]);
  ::waitpid(child, &killed.wait_status, 0);
  return killed;
}

TEST(StoreAfterKill, ContainsEveryCommittedSubmap) {
  std::mt19937 random(11);
  for (int round = 0; round < 20; ++round) {
    const slammot::testing::TemporaryFolder folder;
    const Killed killed =
        kill_while_writing(folder / "map.sqlite", 1 + random() % 8, random() % 20'000);
    ASSERT_TRUE(WIFSIGNALED(killed.wait_status)) << "the child ended by itself";
    auto opened = Store::open(folder / "map.sqlite", {});
    ASSERT_TRUE(std::holds_alternative<Store>(opened));
    Store& store = std::get<Store>(opened);
    const auto listed = store.list("car");
    ASSERT_GE(listed.size(), killed.committed);
    for (const flow::SubmapId id : listed) {
      const auto submap = store.get("car", id);
      ASSERT_TRUE(submap) << store.last_fault();
      EXPECT_TRUE(same_submap(*submap, example_submap(id.value)));
    }
  }
}

}  // namespace
}  // namespace slammot::map_store
