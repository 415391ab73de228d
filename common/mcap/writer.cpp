#include "common/mcap/writer.hpp"

#include <algorithm>

#include "common/bags/mcap_format.hpp"
#include "common/mcap/byte_writer.hpp"

namespace slammot::mcap {
namespace {

namespace format = bags::mcap_format;

Bytes magic() {
  return {reinterpret_cast<const std::uint8_t*>(format::kMagic.data()), format::kMagic.size()};
}

/// The whole chunk record up to its packed records, which follow.
void append_chunk_head(const ChunkBuilder& chunk, const ChunkIndex& index, Buffer& into) {
  const std::uint64_t content_bytes = 8 + 8 + 8 + 4 + 4 + index.compression.size() + 8;
  ByteWriter(into)
      .number(std::uint8_t{format::kChunk})
      .number(content_bytes + index.packed_bytes)
      .number(chunk.start_ns())
      .number(chunk.end_ns())
      .number(index.unpacked_bytes)
      .number(crc32(chunk.records()))
      .text(index.compression)
      .number(index.packed_bytes);
}

}  // namespace

Writer::Writer(FileSink& file, const Header& header, Compression compression)
    : file_(file), packer_(compression), fault_(file.fault()) {
  const Bytes begin = magic();
  buffer_.assign(begin.begin(), begin.end());
  append(header, buffer_);
  put_record();
}

/// Writes bytes of the data section. On a fault the file ends where it ended before.
bool Writer::put(Bytes bytes) {
  if (!fault_.empty()) return false;
  const std::uint64_t begin = file_.position();
  if (!file_.write(bytes)) {
    fault_ = file_.fault();
    file_.cut_to(begin);
    return false;
  }
  data_crc_ = crc32(bytes, data_crc_);
  return true;
}

bool Writer::put_record() {
  const bool is_written = put(buffer_);
  buffer_.clear();
  return is_written;
}

void Writer::know(const Schema& schema) {
  schemas_.emplace(schema.id, schema);
  statistics_.schema_count = static_cast<std::uint16_t>(schemas_.size());
}

void Writer::know(const Channel& channel) {
  channels_.emplace(channel.id, channel);
  statistics_.channel_count = static_cast<std::uint32_t>(channels_.size());
}

bool Writer::write(const ChunkBuilder& chunk) {
  if (chunk.empty()) return fault_.empty();
  const Bytes packed = packer_.pack(chunk.records());
  ChunkIndex index{.start_ns = chunk.start_ns(),
                   .end_ns = chunk.end_ns(),
                   .index_offsets = {},
                   .compression = std::string(name_of(packer_.compression())),
                   .packed_bytes = packed.size(),
                   .unpacked_bytes = chunk.records().size()};
  append_chunk_head(chunk, index, buffer_);
  ByteWriter(buffer_).raw(packed);
  if (!put_chunk(std::move(index), chunk.indexes())) return false;
  for (const Schema& schema : chunk.schemas()) know(schema);
  for (const Channel& channel : chunk.channels()) know(channel);
  return true;
}

bool Writer::write_packed(Bytes chunk_record, const ChunkIndex& as_it_was,
                          std::span<const MessageIndex> indexes) {
  buffer_.assign(chunk_record.begin(), chunk_record.end());
  return put_chunk(as_it_was, indexes);
}

/// Writes the chunk record in the buffer and its indexes as one, so that on a fault both are taken
/// back.
bool Writer::put_chunk(ChunkIndex index, std::span<const MessageIndex> indexes) {
  index.offset = file_.position();
  index.length = buffer_.size();
  index.index_offsets.clear();
  for (const MessageIndex& channel : indexes) {
    index.index_offsets.emplace_back(channel.channel_id, index.offset + buffer_.size());
    append(channel, buffer_);
  }
  index.indexes_length = buffer_.size() - index.length;
  if (!put_record()) return false;
  count(index, indexes);
  chunks_.push_back(std::move(index));
  return true;
}

void Writer::count(const ChunkIndex& chunk, std::span<const MessageIndex> indexes) {
  ++statistics_.chunk_count;
  if (indexes.empty()) return;
  const bool is_first = statistics_.message_count == 0;
  statistics_.start_ns = is_first ? chunk.start_ns : std::min(statistics_.start_ns, chunk.start_ns);
  statistics_.end_ns = is_first ? chunk.end_ns : std::max(statistics_.end_ns, chunk.end_ns);
  for (const MessageIndex& channel : indexes) {
    statistics_.message_count += channel.entries.size();
    statistics_.messages_of[channel.channel_id] += channel.entries.size();
  }
}

bool Writer::write(const Attachment& attachment) {
  const std::uint64_t offset = file_.position();
  append(attachment, buffer_);
  const std::uint64_t length = buffer_.size();
  if (!put_record()) return false;
  ++statistics_.attachment_count;
  attachments_.push_back({offset, length, attachment.log_time_ns, attachment.create_time_ns,
                          attachment.data.size(), attachment.name, attachment.media_type});
  return true;
}

bool Writer::write(const Metadata& metadata) {
  const std::uint64_t offset = file_.position();
  append(metadata, buffer_);
  const std::uint64_t length = buffer_.size();
  if (!put_record()) return false;
  ++statistics_.metadata_count;
  metadata_.push_back({offset, length, metadata.name});
  return true;
}

template <typename Records>
void Writer::append_group(const Records& records, std::uint8_t opcode,
                          std::uint64_t summary_start) {
  const std::size_t begin = buffer_.size();
  for (const auto& record : records) append(record, buffer_);
  if (buffer_.size() > begin)
    offsets_.push_back({opcode, summary_start + begin, buffer_.size() - begin});
}

void Writer::append_summary(std::uint64_t summary_start) {
  std::vector<Schema> schemas;
  for (const auto& [id, schema] : schemas_) schemas.push_back(schema);
  std::vector<Channel> channels;
  for (const auto& [id, channel] : channels_) channels.push_back(channel);
  append_group(schemas, format::kSchema, summary_start);
  append_group(channels, format::kChannel, summary_start);
  append_group(std::span(&statistics_, 1), format::kStatistics, summary_start);
  append_group(chunks_, format::kChunkIndex, summary_start);
  append_group(attachments_, format::kAttachmentIndex, summary_start);
  append_group(metadata_, format::kMetadataIndex, summary_start);
}

bool Writer::finish() {
  const std::uint64_t end_of_data = file_.position();
  append_data_end(data_crc_, buffer_);
  const std::size_t data_end_bytes = buffer_.size();
  const std::uint64_t summary_start = end_of_data + data_end_bytes;
  append_summary(end_of_data);  // offsets count the data end, which is in the buffer, too
  Footer footer{summary_start, end_of_data + buffer_.size(), 0};
  for (const SummaryOffset& offset : offsets_) append(offset, buffer_);
  Buffer end;
  append(footer, end);
  const std::size_t checked_bytes = end.size() - sizeof footer.summary_crc;
  footer.summary_crc =
      crc32(Bytes(end).first(checked_bytes), crc32(Bytes(buffer_).subspan(data_end_bytes)));
  append(footer, buffer_);
  ByteWriter(buffer_).raw(magic());
  const bool is_written = file_.write(buffer_);
  buffer_.clear();
  if (is_written) return true;
  if (fault_.empty()) fault_ = file_.fault();
  file_.cut_to(end_of_data);
  return false;
}

}  // namespace slammot::mcap
