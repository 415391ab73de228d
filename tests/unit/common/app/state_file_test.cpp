#include "common/app/state_file.hpp"

#include <fstream>

#include <gtest/gtest.h>

#include "tests/support/temporary_folder.hpp"

namespace slammot::app {
namespace {

SavedState state_of(std::int64_t stamp_ns, std::size_t size) {
  return {stamp_ns, std::vector<std::byte>(size, std::byte{7})};
}

struct StateFileTest : ::testing::Test {
  slammot::testing::TemporaryFolder folder;
  std::filesystem::path path = folder / "new folder/service.state";

  void save(const SavedState& state) const {
    StateFile(path).save(state);
  }  // the destructor finishes writing
};

TEST_F(StateFileTest, HasNothingAtFirst) { EXPECT_FALSE(StateFile(path).read()); }

TEST_F(StateFileTest, GivesBackTheLastStateSaved) {
  save(state_of(1, 10));
  save(state_of(2, 1'000'000));
  const auto read = StateFile(path).read();
  ASSERT_TRUE(read);
  EXPECT_EQ(read->stamp_ns, 2);
  EXPECT_EQ(read->bytes, state_of(2, 1'000'000).bytes);
}

TEST_F(StateFileTest, KeepsTheLastOfManySavedAtOnce) {
  {
    StateFile file(path);
    for (std::int64_t stamp_ns = 0; stamp_ns < 100; ++stamp_ns)
      file.save(stamp_ns, [stamp_ns] { return state_of(stamp_ns, 10'000).bytes; });
  }
  EXPECT_EQ(StateFile(path).read()->stamp_ns, 99);
}

TEST_F(StateFileTest, DoesNotReadWhatIsCutOffOrDamaged) {
  save(state_of(1, 1000));
  std::filesystem::resize_file(path, 500);
  EXPECT_FALSE(StateFile(path).read());
  save(state_of(1, 1000));
  {
    std::fstream file(path, std::ios::in | std::ios::out | std::ios::binary);
    file.seekp(700);
    file.put('x');
  }
  EXPECT_FALSE(StateFile(path).read());
}

TEST_F(StateFileTest, SaysWhyItCannotWrite) {
  StateFile file("/proc/no/service.state");
  file.save(state_of(1, 10));
  while (file.is_busy()) std::this_thread::yield();
  EXPECT_NE(file.fault(), "");
}

}  // namespace
}  // namespace slammot::app
