#include "services/recorder/recording.hpp"

#include <algorithm>

#include "common/app/version.hpp"

namespace slammot::recorder {
namespace {

mcap::Header header() { return {"", "slammot " + std::string(app::kVersion)}; }

}  // namespace

Recording::Recording(const RecordingOptions& options)
    : options_(options), file_(options.path), writer_(file_, header(), options.compression) {
  for (const mcap::Metadata& metadata : options.metadata) writer_.write(metadata);
  for (const mcap::Attachment& attachment : options.attachments) writer_.write(attachment);
  note_fault(writer_.fault());
  for (std::size_t i = 0; i < options.most_chunks; ++i)
    free_.push_back(std::make_unique<mcap::ChunkBuilder>());
  thread_ = std::thread([this] { write_chunks(); });
}

Recording::~Recording() { finish(); }

mcap::ChannelId Recording::add(const recordings::RecordedTopic& topic) {
  const bool is_kept = dds::offered_qos_of(topic.channel.metadata).is_transient_local;
  KnownChannel known{topic.schema, topic.channel, is_kept ? &kept_ : &passing_};
  const auto same = std::ranges::find_if(channels_, [&](const KnownChannel& other) {
    return other.schema.name == known.schema.name && other.schema.data == known.schema.data;
  });
  const bool is_new = same == channels_.end();
  known.schema.id = is_new ? static_cast<mcap::SchemaId>(channels_.size() + 1) : same->schema.id;
  known.channel.schema_id = known.schema.id;
  known.channel.id = static_cast<mcap::ChannelId>(channels_.size() + 1);
  channels_.push_back(std::move(known));
  return channels_.back().channel.id;
}

/// Whether there is a chunk to add to.
bool Recording::has_room(Chunk& chunk) {
  if (chunk) return true;
  const std::scoped_lock lock(mutex_);
  if (free_.empty() || !fault_.empty()) return false;
  chunk = std::move(free_.back());
  free_.pop_back();
  return true;
}

void Recording::add(mcap::ChannelId channel_id, std::int64_t log_time_ns,
                    std::int64_t publish_time_ns, mcap::Bytes data) {
  KnownChannel& channel = channels_.at(channel_id - std::size_t{1});
  const std::uint32_t sequence = channel.next_sequence++;  // gaps show where messages were dropped
  if (!has_room(*channel.chunk)) {
    ++dropped_;
    return;
  }
  mcap::ChunkBuilder& chunk = **channel.chunk;
  if (!channel.is_written) {
    chunk.add(channel.schema);
    chunk.add(channel.channel);
    channel.is_written = true;
  }
  chunk.add({channel_id, sequence, log_time_ns, publish_time_ns}, data);
  ++recorded_;
  bytes_ += data.size();
  if (chunk.records().size() >= options_.chunk_bytes) hand_over(*channel.chunk);
}

void Recording::flush() {
  hand_over(passing_);
  hand_over(kept_);
}

void Recording::hand_over(Chunk& chunk) {
  if (!chunk || chunk->empty()) return;
  {
    const std::scoped_lock lock(mutex_);
    full_.push_back(std::move(chunk));
  }
  changed_.notify_one();
}

void Recording::write_chunks() {
  std::unique_lock lock(mutex_);
  for (;;) {
    changed_.wait(lock, [this] { return is_ending_ || !full_.empty(); });
    if (full_.empty()) return;
    Chunk chunk = std::move(full_.front());
    full_.pop_front();
    lock.unlock();
    writer_.write(*chunk);
    note_fault(writer_.fault());
    chunk->clear();
    lock.lock();
    free_.push_back(std::move(chunk));
  }
}

void Recording::note_fault(const std::string& fault) {
  const std::scoped_lock lock(mutex_);
  if (fault_.empty()) fault_ = fault;
}

std::string Recording::fault() const {
  const std::scoped_lock lock(mutex_);
  return fault_;
}

bool Recording::finish() {
  if (!thread_.joinable()) return fault().empty();
  flush();
  {
    const std::scoped_lock lock(mutex_);
    is_ending_ = true;
  }
  changed_.notify_one();
  thread_.join();
  writer_.finish();
  note_fault(writer_.fault());
  if (!file_.close()) note_fault(file_.fault());
  return fault().empty();
}

}  // namespace slammot::recorder
