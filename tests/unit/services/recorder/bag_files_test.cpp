#include "services/recorder/bag_files.hpp"

#include <fstream>

#include <gtest/gtest.h>

#include "common/mcap/message_cursor.hpp"
#include "tests/support/mcap_example.hpp"
#include "tests/support/temporary_folder.hpp"

namespace slammot::recorder {
namespace {

class BagFiles : public ::testing::Test {
 protected:
  BagFiles() {
    testing::write_example(whole_, testing::example_messages(300), mcap::Compression::kZstd);
  }

  static std::size_t sound_messages(const std::filesystem::path& path) {
    const auto file = mcap::File::open_and_verify(path);
    if (!file || !file->contents().damage.empty()) return 0;
    return file->contents().statistics.message_count;
  }

  testing::TemporaryFolder folder_;
  std::filesystem::path whole_ = folder_.path() / "whole.mcap";
  std::filesystem::path output_ = folder_.path() / "output.mcap";
};

TEST_F(BagFiles, ARecoveredFileIsSoundWhereverItWasCut) {
  const auto size = std::filesystem::file_size(whole_);
  const std::filesystem::path cut = folder_.path() / "cut.mcap";
  std::size_t least = 0;
  for (int part = 2; part <= 10; ++part) {
    std::filesystem::copy_file(whole_, cut, std::filesystem::copy_options::overwrite_existing);
    std::filesystem::resize_file(cut, size * static_cast<std::uintmax_t>(part) / 11);
    const auto file = mcap::File::open(cut);
    ASSERT_TRUE(file);
    const WrittenBag recovered = recover_bag(*file, output_);
    EXPECT_EQ(recovered.fault, "");
    EXPECT_GE(recovered.messages, least);
    EXPECT_EQ(sound_messages(output_), recovered.messages);
    least = recovered.messages;
    std::filesystem::remove(output_);
  }
  EXPECT_GT(least, 200U);
}

TEST_F(BagFiles, PartsJoinedAreTheWhole) {
  const auto whole = mcap::File::open(whole_);
  ASSERT_TRUE(whole);
  const std::filesystem::path first = folder_.path() / "first.mcap";
  const std::filesystem::path second = folder_.path() / "second.mcap";
  EXPECT_EQ(
      write_bag({&*whole}, {TopicSelection({"sc*"})}, first, mcap::Compression::kLz4).messages,
      150U);
  EXPECT_EQ(
      write_bag({&*whole}, {TopicSelection({"poses"})}, second, mcap::Compression::kNone).messages,
      150U);
  const auto a = mcap::File::open(first);
  const auto b = mcap::File::open(second);
  ASSERT_TRUE(a && b);
  EXPECT_EQ(write_bag({&*a, &*b}, {}, output_, mcap::Compression::kZstd).messages, 300U);
  EXPECT_EQ(sound_messages(output_), 300U);
}

TEST_F(BagFiles, AnExistingFileIsNotOverwritten) {
  const auto whole = mcap::File::open(whole_);
  ASSERT_TRUE(whole);
  EXPECT_NE(write_bag({&*whole}, {}, whole_, mcap::Compression::kZstd).fault, "");
  EXPECT_NE(recover_bag(*whole, whole_).fault, "");
  EXPECT_EQ(sound_messages(whole_), 300U);
}

}  // namespace
}  // namespace slammot::recorder
