#include "common/mcap/file.hpp"

#include <fstream>
#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/mcap/message_cursor.hpp"
#include "tests/support/mcap_example.hpp"
#include "tests/support/temporary_folder.hpp"

namespace slammot::mcap {
namespace {

using ::testing::Contains;
using testing::example_messages;
using ::testing::HasSubstr;
using testing::write_example;

class McapFile : public ::testing::Test {
 protected:
  McapFile() {
    write_example(path_, messages_, Compression::kZstd);
    std::ifstream file(path_, std::ios::binary);
    whole_.assign(std::istreambuf_iterator<char>(file), {});
  }

  std::filesystem::path write(const std::string& bytes) {
    std::ofstream(changed_, std::ios::binary) << bytes;
    return changed_;
  }

  static std::size_t count_messages(const File& file) {
    std::size_t count = 0;
    MessageCursor cursor(file, {});
    while (cursor.next()) ++count;
    return count;
  }

  testing::TemporaryFolder folder_;
  std::filesystem::path path_ = folder_.path() / "whole.mcap";
  std::filesystem::path changed_ = folder_.path() / "changed.mcap";
  std::vector<testing::ExampleMessage> messages_ = example_messages(500);
  std::string whole_;
};

TEST_F(McapFile, CutAnywhereGivesAllChunksBeforeTheCut) {
  const auto whole = File::open(path_);
  ASSERT_TRUE(whole);
  std::mt19937 random(3);  // NOLINT(cert-msc51-cpp): the same ones each time
  for (int i = 0; i < 100; ++i) {
    const std::size_t size = 100 + random() % (whole_.size() - 101);
    const auto cut = File::open(write(whole_.substr(0, size)));
    ASSERT_TRUE(cut) << size;
    std::size_t wanted = 0;
    for (const ChunkIndex& chunk : whole->contents().chunks) {
      if (chunk.offset + chunk.length > size) break;
      for (const MessageIndex& index : indexes_of(whole->chunk(chunk).records))
        wanted += index.entries.size();
    }
    EXPECT_EQ(count_messages(*cut), wanted) << size;
    EXPECT_FALSE(cut->contents().is_whole);
    EXPECT_EQ(cut->contents().damage.empty(), size >= whole->contents().end_of_data) << size;
  }
}

TEST_F(McapFile, VerifyFindsAChangedByteAnywhere) {
  std::mt19937 random(4);  // NOLINT(cert-msc51-cpp): the same ones each time
  for (int i = 0; i < 100; ++i) {
    std::string changed = whole_;
    const std::size_t at = 8 + random() % (whole_.size() - 8);
    changed[at] = static_cast<char>(changed[at] ^ (1 << (random() % 8)));
    const auto file = File::open_and_verify(write(changed));
    EXPECT_TRUE(!file || !file->contents().damage.empty()) << at;
  }
}

TEST_F(McapFile, ADamagedChunkIsLeftOutAndNamed) {
  const auto whole = File::open(path_);
  ASSERT_TRUE(whole);
  const ChunkIndex& second = whole->contents().chunks[1];
  std::string changed = whole_;
  changed[second.offset + second.length / 2] ^= 1;
  const auto file = File::open_and_verify(write(changed));
  ASSERT_TRUE(file);
  EXPECT_EQ(file->contents().chunks.size(), whole->contents().chunks.size() - 1);
  EXPECT_THAT(file->contents().damage,
              Contains(HasSubstr("byte " + std::to_string(second.offset) + ": the chunk ")));
}

TEST_F(McapFile, OtherFilesAreRefused) {
  EXPECT_FALSE(File::open(folder_.path() / "none.mcap"));
  EXPECT_FALSE(File::open(write("something else")));
  EXPECT_FALSE(File::open(write("")));
  EXPECT_FALSE(File::open(folder_.path()));
}

TEST_F(McapFile, AttachmentsAndMetadataAreFound) {
  const auto file = File::open(path_);
  ASSERT_TRUE(file);
  ASSERT_EQ(file->contents().attachments.size(), 1U);
  const auto attachment = file->attachment(file->contents().attachments.front());
  ASSERT_TRUE(attachment);
  EXPECT_EQ(attachment->name, "settings");
  EXPECT_EQ(attachment->data, (Buffer{'h', 'i'}));
  ASSERT_EQ(file->contents().metadata.size(), 1U);
  EXPECT_EQ(file->metadata(file->contents().metadata.front())->values.at("version"), "1");
}

}  // namespace
}  // namespace slammot::mcap
