#include "common/mcap/stream_writer.hpp"

namespace slammot::mcap {
namespace {

/// Adds the record unless there is one that differs in its id only. Its id.
template <typename Record>
std::uint16_t id_in(std::vector<Record>& known, Record& record, ChunkBuilder& chunk) {
  for (const Record& other : known) {
    record.id = other.id;
    if (record == other) return other.id;
  }
  record.id = static_cast<std::uint16_t>(known.size() + 1);
  chunk.add(record);
  known.push_back(record);
  return record.id;
}

}  // namespace

StreamWriter::StreamWriter(const std::filesystem::path& path, const Header& header,
                           Compression compression, std::size_t chunk_bytes)
    : file_(path), writer_(file_, header, compression), chunk_bytes_(chunk_bytes) {}

SchemaId StreamWriter::add(Schema schema) { return id_in(schemas_, schema, chunk_); }

ChannelId StreamWriter::add(Channel channel) { return id_in(channels_, channel, chunk_); }

bool StreamWriter::add(const MessageHead& head, Bytes data) {
  chunk_.add(head, data);
  return chunk_.records().size() <= chunk_bytes_ || flush();
}

bool StreamWriter::flush() {
  const bool is_written = writer_.write(chunk_);
  chunk_.clear();
  return is_written;
}

bool StreamWriter::finish() {
  const bool is_flushed = flush();
  const bool is_finished = writer_.finish();
  return file_.close() && is_flushed && is_finished;
}

}  // namespace slammot::mcap
