#include "services/recorder/recording.hpp"

#include <gtest/gtest.h>

#include "common/mcap/message_cursor.hpp"
#include "services/recorder/sample_batch.hpp"
#include "tests/support/temporary_folder.hpp"

namespace slammot::recorder {
namespace {

class RecordingToFile : public ::testing::Test {
 protected:
  static recordings::RecordedTopic topic(const std::string& name) {
    return {{0, "Type", "omgidl", {'x'}}, {0, 0, name, "cdr", {}}};
  }

  std::vector<mcap::MessageHead> heads() const {
    std::vector<mcap::MessageHead> all;
    const auto file = mcap::File::open(options_.path);
    if (!file) return all;
    mcap::MessageCursor cursor(*file, {});
    while (const auto message = cursor.next()) all.push_back(message->head);
    return all;
  }

  testing::TemporaryFolder folder_;
  RecordingOptions options_{folder_.path() / "recording.mcap"};
};

TEST_F(RecordingToFile, TopicsOfOneTypeShareTheirSchema) {
  Recording recording(options_);
  const std::vector<std::uint8_t> data(100, 1);
  recording.add(recording.add(topic("a")), 1, 1, data);
  recording.add(recording.add(topic("b")), 2, 2, data);
  ASSERT_TRUE(recording.finish());
  const auto file = mcap::File::open_and_verify(options_.path);
  ASSERT_TRUE(file);
  EXPECT_EQ(file->contents().schemas.size(), 1U);
  EXPECT_EQ(file->contents().channels.size(), 2U);
  EXPECT_EQ(file->contents().damage, std::vector<std::string>{});
}

TEST_F(RecordingToFile, WhatTheBusKeepsIsInChunksOfItsOwn) {
  recordings::RecordedTopic map = topic("map");
  map.channel.metadata = {{"qos.durability", "transient_local"}};
  Recording recording(options_);
  const mcap::ChannelId scans = recording.add(topic("scans"));
  const mcap::ChannelId tiles = recording.add(map);
  const std::vector<std::uint8_t> data(100, 1);
  for (const std::int64_t stamp_ns : {1, 2, 3, 4, 5, 6}) {
    recording.add(stamp_ns % 3 == 0 ? tiles : scans, stamp_ns, stamp_ns, data);
    if (stamp_ns == 3) recording.flush();
  }
  ASSERT_TRUE(recording.finish());
  const auto file = mcap::File::open(options_.path);
  ASSERT_TRUE(file);
  std::vector<std::vector<mcap::ChannelId>> channels_of_chunks;
  for (const mcap::ChunkIndex& chunk : file->contents().chunks) {
    channels_of_chunks.emplace_back();
    for (const auto& [channel, offset] : chunk.index_offsets)
      channels_of_chunks.back().push_back(channel);
  }
  EXPECT_EQ(channels_of_chunks,
            (std::vector<std::vector<mcap::ChannelId>>{{scans}, {tiles}, {scans}, {tiles}}));
  std::vector<std::int64_t> times;
  for (const mcap::MessageHead& head : heads()) times.push_back(head.log_time_ns);
  EXPECT_EQ(times, (std::vector<std::int64_t>{1, 2, 3, 4, 5, 6}));
}

TEST_F(RecordingToFile, DroppedMessagesAreCountedAndLeaveAGap) {
  options_.most_chunks = 0;
  Recording recording(options_);
  const mcap::ChannelId channel = recording.add(topic("a"));
  recording.add(channel, 1, 1, std::vector<std::uint8_t>(10));
  EXPECT_EQ(recording.dropped(), 1U);
  EXPECT_EQ(recording.recorded(), 0U);
  EXPECT_TRUE(recording.finish());
  EXPECT_TRUE(heads().empty());
}

TEST_F(RecordingToFile, AFileThatCannotBeMadeIsAFault) {
  options_.path = folder_.path() / "missing" / "file.mcap";
  Recording recording(options_);
  EXPECT_NE(recording.fault(), "");
  EXPECT_FALSE(recording.finish());
}

TEST_F(RecordingToFile, ABatchIsPutIntoTheOrderOfItsSourceTimes) {
  Recording recording(options_);
  const mcap::ChannelId channel = recording.add(topic("a"));
  SampleBatch batch;
  const std::vector<std::uint8_t> data(4, 9);
  for (const std::int64_t source_ns : {1500, 1200, 99'000, 3}) batch.add(channel, source_ns, data);
  batch.move_to(recording, 1000, 2000);
  ASSERT_TRUE(recording.finish());
  std::vector<std::pair<std::int64_t, std::int64_t>> times;
  for (const mcap::MessageHead& head : heads())
    times.emplace_back(head.log_time_ns, head.publish_time_ns);
  EXPECT_EQ(times, (std::vector<std::pair<std::int64_t, std::int64_t>>{
                       {1000, 3}, {1200, 1200}, {1500, 1500}, {2000, 99'000}}));
}

}  // namespace
}  // namespace slammot::recorder
