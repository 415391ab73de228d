#include "common/mcap/message_cursor.hpp"

#include <gtest/gtest.h>

#include "tests/support/mcap_example.hpp"
#include "tests/support/temporary_folder.hpp"

namespace slammot::mcap {
namespace {

using testing::example_messages;
using testing::write_example;

class McapCursor : public ::testing::Test {
 protected:
  std::vector<std::int64_t> times(const Selection& selection) {
    const auto file = File::open(path_);
    std::vector<std::int64_t> all;
    if (!file) return all;
    MessageCursor cursor(*file, selection);
    while (const auto message = cursor.next()) all.push_back(message->head.log_time_ns);
    return all;
  }

  testing::TemporaryFolder folder_;
  std::filesystem::path path_ = folder_.path() / "example.mcap";
};

TEST_F(McapCursor, ReadsByLogTimeAlsoWhereTheFileIsOutOfOrder) {
  auto messages = example_messages(200);
  std::ranges::reverse(messages);
  ASSERT_TRUE(write_example(path_, messages, Compression::kZstd));
  const auto all = times({});
  EXPECT_EQ(all.size(), 200U);
  EXPECT_TRUE(std::ranges::is_sorted(all));
}

TEST_F(McapCursor, KeepsTheOrderOfTheFileWithinOneTime) {
  auto messages = example_messages(60);
  for (auto& message : messages) message.log_time_ns = 7;
  ASSERT_TRUE(write_example(path_, messages, Compression::kNone));
  const auto file = File::open(path_);
  ASSERT_TRUE(file);
  MessageCursor cursor(*file, {});
  for (const auto& wanted : messages) {
    const auto message = cursor.next();
    ASSERT_TRUE(message);
    EXPECT_EQ(message->channel->topic, wanted.topic);
    EXPECT_EQ(message->head.sequence, wanted.sequence);
  }
}

TEST_F(McapCursor, ReadsOnlyTheSelectedTimesAndTopics) {
  ASSERT_TRUE(write_example(path_, example_messages(200), Compression::kZstd));
  const std::int64_t from_ns = 1'500'000'000;
  const std::int64_t to_ns = 1'700'000'000;
  const auto some = times({{"poses"}, from_ns, to_ns});
  EXPECT_EQ(some.size(), 10U);  // every 20 ms
  for (const std::int64_t time_ns : some) {
    EXPECT_GE(time_ns, from_ns);
    EXPECT_LE(time_ns, to_ns);
  }
  EXPECT_TRUE(times({{"nothing"}, from_ns, to_ns}).empty());
}

}  // namespace
}  // namespace slammot::mcap
