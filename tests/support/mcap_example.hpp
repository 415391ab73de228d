#pragma once

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <random>
#include <string>
#include <vector>

#include "common/mcap/stream_writer.hpp"

namespace slammot::testing {

/// A message as a test hands it over and gets it back.
struct ExampleMessage {
  std::string topic;
  std::uint32_t sequence = 0;
  std::int64_t log_time_ns = 0;
  std::int64_t publish_time_ns = 0;
  std::vector<std::uint8_t> data;

  bool operator==(const ExampleMessage&) const = default;
};

/// Messages of two topics in turn, 10 ms apart, with sizes from 4 to 3000 bytes that pack.
inline std::vector<ExampleMessage> example_messages(std::size_t count) {
  std::mt19937 random(7);  // NOLINT(cert-msc51-cpp): the same ones each time
  std::vector<ExampleMessage> messages;
  for (std::size_t i = 0; i < count; ++i) {
    ExampleMessage message;
    message.topic = i % 2 == 0 ? "scans" : "poses";
    message.sequence = static_cast<std::uint32_t>(i / 2);
    message.log_time_ns = 1'000'000'000 + static_cast<std::int64_t>(i) * 10'000'000;
    message.publish_time_ns = message.log_time_ns - 12'345;
    message.data.resize(4 + random() % 3000);
    std::ranges::generate(message.data, [&] { return static_cast<std::uint8_t>(random() % 7); });
    messages.push_back(std::move(message));
  }
  return messages;
}

/// Writes the messages with an attachment and metadata. True if all of it is on the disk.
inline bool write_example(const std::filesystem::path& path,
                          const std::vector<ExampleMessage>& messages,
                          mcap::Compression compression, std::size_t chunk_bytes = 20'000) {
  mcap::StreamWriter writer(path, {"", "example"}, compression, chunk_bytes);
  writer.write(mcap::Metadata{"software", {{"version", "1"}, {"name", "example"}}});
  const mcap::SchemaId scan = writer.add(mcap::Schema{0, "test::Scan", "omgidl", {'i', 'd', 'l'}});
  const mcap::SchemaId pose = writer.add(mcap::Schema{0, "test::Pose", "omgidl", {'x'}});
  const mcap::ChannelId scans =
      writer.add(mcap::Channel{0, scan, "scans", "cdr", {{"a", "1"}, {"b", ""}}});
  const mcap::ChannelId poses = writer.add(mcap::Channel{0, pose, "poses", "cdr", {}});
  for (const ExampleMessage& message : messages) {
    const mcap::ChannelId channel = message.topic == "scans" ? scans : poses;
    writer.add({channel, message.sequence, message.log_time_ns, message.publish_time_ns},
               message.data);
  }
  writer.write(mcap::Attachment{5, 6, "settings", "text/plain", {'h', 'i'}});
  return writer.finish();
}

}  // namespace slammot::testing
