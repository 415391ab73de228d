#include "common/files/atomic_file.hpp"

#include <filesystem>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "tests/support/temporary_folder.hpp"
#include "tests/unit/common/files/log_text.hpp"

namespace slammot::files {
namespace {

using ::testing::HasSubstr;

std::size_t files_in(const std::filesystem::path& folder) {
  return static_cast<std::size_t>(std::distance(std::filesystem::directory_iterator(folder),
                                                std::filesystem::directory_iterator()));
}

TEST(WriteFileAtomically, ReplacesTheOldFileAndLeavesNothingElse) {
  const testing::TemporaryFolder folder;
  EXPECT_FALSE(write_file_atomically(folder / "a", "old"));
  EXPECT_FALSE(write_file_atomically(folder / "a", std::string("new\0bytes", 9)));
  EXPECT_EQ(testing::read_file(folder / "a"), std::string("new\0bytes", 9));
  EXPECT_EQ(files_in(folder.path()), 1u);
}

TEST(WriteFileAtomically, SaysWhyItCannot) {
  const testing::TemporaryFolder folder;
  const auto fault = write_file_atomically(folder / "missing" / "a", "text");
  ASSERT_TRUE(fault);
  EXPECT_THAT(fault->message, HasSubstr("cannot write"));
  EXPECT_THAT(fault->message, HasSubstr("No such file or directory"));
}

TEST(WriteFileAtomically, NoticesAFullDisk) {
  if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "no /dev/full on this machine";
  const testing::TemporaryFolder folder;
  const std::string temporary = "a.tmp" + std::to_string(::getpid());
  std::filesystem::create_symlink("/dev/full", folder / temporary);
  const auto fault = write_file_atomically(folder / "a", "text");
  ASSERT_TRUE(fault);
  EXPECT_THAT(fault->message, HasSubstr("No space left on device"));
  EXPECT_FALSE(std::filesystem::exists(folder / "a"));
}

TEST(PrepareOutputFolder, MakesItWithItsParentsAndLeavesItEmpty) {
  const testing::TemporaryFolder folder;
  EXPECT_FALSE(prepare_output_folder(folder / "a" / "b"));
  EXPECT_EQ(files_in(folder / "a" / "b"), 0u);
}

TEST(PrepareOutputFolder, RefusesWhereAFileIsInTheWay) {
  const testing::TemporaryFolder folder;
  testing::write_file(folder / "a", "file");
  EXPECT_TRUE(prepare_output_folder(folder / "a"));
  EXPECT_TRUE(prepare_output_folder(folder / "a" / "b"));
}

}  // namespace
}  // namespace slammot::files
