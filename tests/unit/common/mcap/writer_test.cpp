#include "common/mcap/writer.hpp"

#include <sys/resource.h>

#include <csignal>

#include <gtest/gtest.h>

#include "common/bags/bag.hpp"
#include "common/bags/mcap_format.hpp"
#include "common/mcap/message_cursor.hpp"
#include "tests/support/mcap_example.hpp"
#include "tests/support/temporary_folder.hpp"

namespace slammot::mcap {
namespace {

using testing::example_messages;
using testing::ExampleMessage;
using testing::write_example;

class McapWriter : public ::testing::Test {
 protected:
  std::vector<ExampleMessage> read(const std::filesystem::path& path) {
    std::vector<ExampleMessage> messages;
    const auto file = File::open(path);
    if (!file) return messages;
    MessageCursor cursor(*file, {});
    while (const auto message = cursor.next())
      messages.push_back({message->channel->topic,
                          message->head.sequence,
                          message->head.log_time_ns,
                          message->head.publish_time_ns,
                          {message->data.begin(), message->data.end()}});
    return messages;
  }

  testing::TemporaryFolder folder_;
  std::filesystem::path path_ = folder_.path() / "example.mcap";
};

TEST_F(McapWriter, MessagesComeBackWithEachCompression) {
  const auto messages = example_messages(300);
  for (const Compression compression :
       {Compression::kNone, Compression::kLz4, Compression::kZstd}) {
    ASSERT_TRUE(write_example(path_, messages, compression));
    EXPECT_EQ(read(path_), messages) << name_of(compression);
    std::filesystem::remove(path_);
  }
}

TEST_F(McapWriter, TheReaderOfBagsReadsItsFiles) {
  const auto messages = example_messages(300);
  ASSERT_TRUE(write_example(path_, messages, Compression::kZstd));
  const bags::OpenedBag bag = bags::open_bag(path_);
  ASSERT_TRUE(bag.messages) << bag.fault;
  std::size_t count = 0;
  while (const auto message = bag.messages->next()) {
    ASSERT_LT(count, messages.size());
    EXPECT_EQ(message->channel->topic, messages[count].topic);
    EXPECT_EQ(message->log_time_ns, messages[count].log_time_ns);
    EXPECT_TRUE(std::ranges::equal(message->bytes, messages[count].data));
    ++count;
  }
  EXPECT_EQ(count, messages.size());
  EXPECT_EQ(bag.messages->damage(), "");
}

TEST_F(McapWriter, EveryChecksumAndIndexIsRight) {
  ASSERT_TRUE(write_example(path_, example_messages(300), Compression::kZstd));
  const auto file = File::open_and_verify(path_);
  ASSERT_TRUE(file);
  EXPECT_EQ(file->contents().damage, std::vector<std::string>{});
  EXPECT_TRUE(file->contents().is_whole);
  EXPECT_NE(file->contents().data_crc, 0U);
  EXPECT_EQ(file->contents().statistics.message_count, 300U);
  EXPECT_GT(file->contents().chunks.size(), 5U);
}

TEST_F(McapWriter, AFileWithoutMessagesIsSound) {
  ASSERT_TRUE(write_example(path_, {}, Compression::kZstd));
  const auto file = File::open_and_verify(path_);
  ASSERT_TRUE(file);
  EXPECT_TRUE(file->contents().is_whole);
  EXPECT_EQ(file->contents().damage, std::vector<std::string>{});
}

TEST_F(McapWriter, EveryIndexEntryPointsToItsMessage) {
  ASSERT_TRUE(write_example(path_, example_messages(100), Compression::kLz4));
  const auto file = File::open(path_);
  ASSERT_TRUE(file);
  const FileBytes bytes(path_);
  std::size_t entries = 0;
  for (const ChunkIndex& chunk : file->contents().chunks) {
    const Buffer records = file->chunk(chunk).records;
    for (const auto& [channel_id, offset] : chunk.index_offsets) {
      const Buffer record = bytes.read(offset, chunk.indexes_length);
      bags::ByteReader reader(Bytes(record).subspan(1));
      const auto index = read_message_index(reader.take(reader.number<std::uint64_t>()));
      ASSERT_TRUE(index);
      EXPECT_EQ(index->channel_id, channel_id);
      for (const MessageIndex::Entry& entry : index->entries) {
        const auto head = read_message_head(
            Bytes(records).subspan(entry.offset + bags::mcap_format::kRecordHeadBytes));
        ASSERT_TRUE(head);
        EXPECT_EQ(head->channel_id, channel_id);
        EXPECT_EQ(head->log_time_ns, entry.log_time_ns);
        ++entries;
      }
    }
  }
  EXPECT_EQ(entries, 100U);
}

TEST_F(McapWriter, RefusesToOverwriteAFile) {
  ASSERT_TRUE(write_example(path_, example_messages(10), Compression::kZstd));
  EXPECT_FALSE(write_example(path_, example_messages(20), Compression::kZstd));
  EXPECT_EQ(read(path_).size(), 10U);
}

/// Files of this process may become so large, and writing more fails as on a full disk.
class FileSizeLimit {
 public:
  explicit FileSizeLimit(rlim_t bytes) {
    std::signal(SIGXFSZ, SIG_IGN);
    getrlimit(RLIMIT_FSIZE, &before_);
    rlimit limit = before_;
    limit.rlim_cur = bytes;
    setrlimit(RLIMIT_FSIZE, &limit);
  }
  ~FileSizeLimit() { setrlimit(RLIMIT_FSIZE, &before_); }
  FileSizeLimit(const FileSizeLimit&) = delete;
  FileSizeLimit& operator=(const FileSizeLimit&) = delete;

 private:
  rlimit before_{};
};

TEST_F(McapWriter, OnAFullDiskAllWholeChunksStayReadable) {
  const auto messages = example_messages(400);
  {
    const FileSizeLimit limit(200'000);
    EXPECT_FALSE(write_example(path_, messages, Compression::kNone));
  }
  const auto kept = read(path_);
  ASSERT_GT(kept.size(), 100U);
  EXPECT_TRUE(std::equal(kept.begin(), kept.end(), messages.begin()));
}

TEST_F(McapWriter, OnAFullDiskTheEndIsWrittenWhereTheLastChunkDidNotFit) {
  const auto messages = example_messages(400);
  {
    const FileSizeLimit limit(195'000);  // ends within a chunk, which leaves room for the end
    EXPECT_FALSE(write_example(path_, messages, Compression::kNone, 40'000));
  }
  const auto file = File::open_and_verify(path_);
  ASSERT_TRUE(file);
  EXPECT_TRUE(file->contents().is_whole);
  EXPECT_EQ(file->contents().damage, std::vector<std::string>{});
}

}  // namespace
}  // namespace slammot::mcap
