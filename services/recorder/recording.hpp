#pragma once

#include <condition_variable>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "common/mcap/writer.hpp"
#include "common/recordings/recorded_topic.hpp"

namespace slammot::recorder {

struct RecordingOptions {
  std::filesystem::path path;
  mcap::Compression compression = mcap::Compression::kZstd;
  std::vector<mcap::Metadata> metadata = {};
  std::vector<mcap::Attachment> attachments = {};
  std::size_t chunk_bytes = std::size_t{1} << 20;
  std::size_t most_chunks = 64;  ///< Memory for a disk that stalls: with the above 64 MB.
};

/// A recording under way. Messages are copied into chunks; a thread packs the chunks and writes
/// them, so that a slow disk never holds up who adds messages. What the bus keeps for late joiners,
/// such as the map, has chunks of its own: a player reads these alone to know what there was at any
/// time. Without a free chunk messages are dropped and counted. Add messages from one thread.
class Recording {
 public:
  /// Begins the file. fault() says whether that failed.
  explicit Recording(const RecordingOptions& options);
  /// Ends the file.
  ~Recording();
  Recording(const Recording&) = delete;
  Recording& operator=(const Recording&) = delete;

  mcap::ChannelId add(const recordings::RecordedTopic& topic);
  void add(mcap::ChannelId channel, std::int64_t log_time_ns, std::int64_t publish_time_ns,
           mcap::Bytes data);
  /// Hands the present chunks to the writing thread: what was added is in the file soon.
  void flush();
  /// Writes what is left and ends the file. True if all that was not dropped is on the disk.
  bool finish();

  std::uint64_t recorded() const { return recorded_; }  ///< Messages.
  std::uint64_t dropped() const { return dropped_; }
  std::uint64_t bytes() const { return bytes_; }  ///< Of messages, unpacked.
  /// What stopped the recording, such as a full disk; empty if nothing did.
  std::string fault() const;

 private:
  using Chunk = std::unique_ptr<mcap::ChunkBuilder>;
  struct KnownChannel {
    mcap::Schema schema;
    mcap::Channel channel;
    Chunk* chunk = nullptr;  ///< The present one of its kind.
    std::uint32_t next_sequence = 0;
    bool is_written = false;
  };

  bool has_room(Chunk& chunk);
  void hand_over(Chunk& chunk);
  void write_chunks();
  void note_fault(const std::string& fault);

  RecordingOptions options_;
  mcap::FileSink file_;
  mcap::Writer writer_;  ///< Of the writing thread until it has ended.
  std::vector<KnownChannel> channels_;
  Chunk passing_;  ///< Null, as the next one: none is free.
  Chunk kept_;     ///< Of topics that the bus keeps for late joiners.
  std::uint64_t recorded_ = 0;
  std::uint64_t dropped_ = 0;
  std::uint64_t bytes_ = 0;

  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<Chunk> full_;
  std::vector<Chunk> free_;
  std::string fault_;
  bool is_ending_ = false;
  std::thread thread_;
};

}  // namespace slammot::recorder
