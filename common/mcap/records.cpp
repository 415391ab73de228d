#include "common/mcap/records.hpp"

#include <zlib.h>

#include "common/bags/mcap_format.hpp"
#include "common/mcap/byte_writer.hpp"

namespace slammot::mcap {
namespace {

using bags::ByteReader;
using namespace bags::mcap_format;

/// Writes opcode and length, and the length's value at its end.
class Record : public ByteWriter {
 public:
  Record(Opcode opcode, Buffer& into) : ByteWriter(into), length_at_(into.size() + 1) {
    number(static_cast<std::uint8_t>(opcode)).number(std::uint64_t{0});
  }
  ~Record() { length_of_rest<std::uint64_t>(length_at_); }
  Record(const Record&) = delete;
  Record& operator=(const Record&) = delete;

 private:
  std::size_t length_at_;
};

std::map<std::string, std::string> read_texts(ByteReader& reader) {
  std::map<std::string, std::string> texts;
  ByteReader pairs(reader.take(reader.number<std::uint32_t>()));
  while (pairs.left() > 0) {
    const std::string key(pairs.text());
    const std::string value(pairs.text());
    if (!pairs.is_ok()) {
      reader.fail();
      break;
    }
    texts.emplace(key, value);
  }
  return texts;
}

template <typename Value>
std::optional<Value> if_read(const ByteReader& reader, Value value) {
  return reader.is_ok() ? std::optional<Value>(std::move(value)) : std::nullopt;
}

}  // namespace

void append(const Header& header, Buffer& into) {
  Record(kHeader, into).text(header.profile).text(header.library);
}

void append(const Schema& schema, Buffer& into) {
  Record(kSchema, into)
      .number(schema.id)
      .text(schema.name)
      .text(schema.encoding)
      .text(bags::text_of(schema.data));
}

void append(const Channel& channel, Buffer& into) {
  Record(kChannel, into)
      .number(channel.id)
      .number(channel.schema_id)
      .text(channel.topic)
      .text(channel.message_encoding)
      .texts(channel.metadata);
}

void append(const MessageHead& head, Bytes data, Buffer& into) {
  Record(kMessage, into)
      .number(head.channel_id)
      .number(head.sequence)
      .number(head.log_time_ns)
      .number(head.publish_time_ns)
      .raw(data);
}

void append(const Attachment& attachment, Buffer& into) {
  Record record(kAttachment, into);
  const std::size_t content_at = into.size();
  record.number(attachment.log_time_ns)
      .number(attachment.create_time_ns)
      .text(attachment.name)
      .text(attachment.media_type)
      .number(std::uint64_t{attachment.data.size()})
      .raw(attachment.data);
  record.number(crc32(Bytes(into).subspan(content_at)));
}

void append(const Metadata& metadata, Buffer& into) {
  Record(kMetadata, into).text(metadata.name).texts(metadata.values);
}

void append(const MessageIndex& index, Buffer& into) {
  Record record(kMessageIndex, into);
  record.number(index.channel_id);
  record.number(static_cast<std::uint32_t>(index.entries.size() * 16));
  for (const MessageIndex::Entry& entry : index.entries)
    record.number(entry.log_time_ns).number(entry.offset);
}

void append(const ChunkIndex& index, Buffer& into) {
  Record record(kChunkIndex, into);
  record.number(index.start_ns).number(index.end_ns).number(index.offset).number(index.length);
  record.number(static_cast<std::uint32_t>(index.index_offsets.size() * 10));
  for (const auto& [channel_id, offset] : index.index_offsets)
    record.number(channel_id).number(offset);
  record.number(index.indexes_length)
      .text(index.compression)
      .number(index.packed_bytes)
      .number(index.unpacked_bytes);
}

void append(const AttachmentIndex& index, Buffer& into) {
  Record(kAttachmentIndex, into)
      .number(index.offset)
      .number(index.length)
      .number(index.log_time_ns)
      .number(index.create_time_ns)
      .number(index.data_bytes)
      .text(index.name)
      .text(index.media_type);
}

void append(const MetadataIndex& index, Buffer& into) {
  Record(kMetadataIndex, into).number(index.offset).number(index.length).text(index.name);
}

void append(const Statistics& statistics, Buffer& into) {
  Record record(kStatistics, into);
  record.number(statistics.message_count)
      .number(statistics.schema_count)
      .number(statistics.channel_count)
      .number(statistics.attachment_count)
      .number(statistics.metadata_count)
      .number(statistics.chunk_count)
      .number(statistics.start_ns)
      .number(statistics.end_ns);
  record.number(static_cast<std::uint32_t>(statistics.messages_of.size() * 10));
  for (const auto& [channel_id, count] : statistics.messages_of)
    record.number(channel_id).number(count);
}

void append(const SummaryOffset& offset, Buffer& into) {
  Record(kSummaryOffset, into).number(offset.opcode).number(offset.start).number(offset.length);
}

void append(const Footer& footer, Buffer& into) {
  Record(kFooter, into)
      .number(footer.summary_start)
      .number(footer.offsets_start)
      .number(footer.summary_crc);
}

void append_data_end(std::uint32_t data_crc, Buffer& into) {
  Record(kDataEnd, into).number(data_crc);
}

std::optional<Header> read_header(Bytes content) {
  ByteReader reader(content);
  Header header;
  header.profile = reader.text();
  header.library = reader.text();
  return if_read(reader, std::move(header));
}

std::optional<Schema> read_schema(Bytes content) {
  ByteReader reader(content);
  Schema schema;
  schema.id = reader.number<SchemaId>();
  schema.name = reader.text();
  schema.encoding = reader.text();
  const Bytes data = reader.take(reader.number<std::uint32_t>());
  schema.data.assign(data.begin(), data.end());
  if (schema.id == 0) return std::nullopt;
  return if_read(reader, std::move(schema));
}

std::optional<Channel> read_channel(Bytes content) {
  ByteReader reader(content);
  Channel channel;
  channel.id = reader.number<ChannelId>();
  channel.schema_id = reader.number<SchemaId>();
  channel.topic = reader.text();
  channel.message_encoding = reader.text();
  channel.metadata = read_texts(reader);
  return if_read(reader, std::move(channel));
}

std::optional<MessageHead> read_message_head(Bytes content) {
  ByteReader reader(content);
  MessageHead head;
  head.channel_id = reader.number<ChannelId>();
  head.sequence = reader.number<std::uint32_t>();
  head.log_time_ns = reader.number<std::int64_t>();
  head.publish_time_ns = reader.number<std::int64_t>();
  return if_read(reader, head);
}

std::optional<Attachment> read_attachment(Bytes content) {
  ByteReader reader(content);
  Attachment attachment;
  attachment.log_time_ns = reader.number<std::int64_t>();
  attachment.create_time_ns = reader.number<std::int64_t>();
  attachment.name = reader.text();
  attachment.media_type = reader.text();
  const Bytes data = reader.take(reader.number<std::uint64_t>());
  attachment.data.assign(data.begin(), data.end());
  const std::size_t checked_bytes = reader.position();
  const auto crc = reader.number<std::uint32_t>();
  if (!reader.is_ok() || (crc != 0 && crc != crc32(content.first(checked_bytes))))
    return std::nullopt;
  return attachment;
}

std::optional<Metadata> read_metadata(Bytes content) {
  ByteReader reader(content);
  Metadata metadata;
  metadata.name = reader.text();
  metadata.values = read_texts(reader);
  return if_read(reader, std::move(metadata));
}

std::optional<MessageIndex> read_message_index(Bytes content) {
  ByteReader reader(content);
  MessageIndex index;
  index.channel_id = reader.number<ChannelId>();
  ByteReader entries(reader.take(reader.number<std::uint32_t>()));
  while (entries.left() >= 16) {
    const auto log_time_ns = entries.number<std::int64_t>();
    index.entries.push_back({log_time_ns, entries.number<std::uint64_t>()});
  }
  if (entries.left() > 0) return std::nullopt;
  return if_read(reader, std::move(index));
}

std::optional<ChunkIndex> read_chunk_index(Bytes content) {
  ByteReader reader(content);
  ChunkIndex index;
  index.start_ns = reader.number<std::int64_t>();
  index.end_ns = reader.number<std::int64_t>();
  index.offset = reader.number<std::uint64_t>();
  index.length = reader.number<std::uint64_t>();
  ByteReader offsets(reader.take(reader.number<std::uint32_t>()));
  while (offsets.left() >= 10) {
    const auto channel_id = offsets.number<ChannelId>();
    index.index_offsets.emplace_back(channel_id, offsets.number<std::uint64_t>());
  }
  index.indexes_length = reader.number<std::uint64_t>();
  index.compression = reader.text();
  index.packed_bytes = reader.number<std::uint64_t>();
  index.unpacked_bytes = reader.number<std::uint64_t>();
  return if_read(reader, std::move(index));
}

std::optional<AttachmentIndex> read_attachment_index(Bytes content) {
  ByteReader reader(content);
  AttachmentIndex index;
  index.offset = reader.number<std::uint64_t>();
  index.length = reader.number<std::uint64_t>();
  index.log_time_ns = reader.number<std::int64_t>();
  index.create_time_ns = reader.number<std::int64_t>();
  index.data_bytes = reader.number<std::uint64_t>();
  index.name = reader.text();
  index.media_type = reader.text();
  return if_read(reader, std::move(index));
}

std::optional<MetadataIndex> read_metadata_index(Bytes content) {
  ByteReader reader(content);
  MetadataIndex index;
  index.offset = reader.number<std::uint64_t>();
  index.length = reader.number<std::uint64_t>();
  index.name = reader.text();
  return if_read(reader, std::move(index));
}

std::optional<Statistics> read_statistics(Bytes content) {
  ByteReader reader(content);
  Statistics statistics;
  statistics.message_count = reader.number<std::uint64_t>();
  statistics.schema_count = reader.number<std::uint16_t>();
  statistics.channel_count = reader.number<std::uint32_t>();
  statistics.attachment_count = reader.number<std::uint32_t>();
  statistics.metadata_count = reader.number<std::uint32_t>();
  statistics.chunk_count = reader.number<std::uint32_t>();
  statistics.start_ns = reader.number<std::int64_t>();
  statistics.end_ns = reader.number<std::int64_t>();
  ByteReader counts(reader.take(reader.number<std::uint32_t>()));
  while (counts.left() >= 10) {
    const auto channel_id = counts.number<ChannelId>();
    statistics.messages_of[channel_id] = counts.number<std::uint64_t>();
  }
  return if_read(reader, std::move(statistics));
}

std::optional<Footer> read_footer(Bytes content) {
  ByteReader reader(content);
  Footer footer;
  footer.summary_start = reader.number<std::uint64_t>();
  footer.offsets_start = reader.number<std::uint64_t>();
  footer.summary_crc = reader.number<std::uint32_t>();
  return if_read(reader, footer);
}

std::uint32_t crc32(Bytes bytes, std::uint32_t before) {
  return static_cast<std::uint32_t>(::crc32_z(before, bytes.data(), bytes.size()));
}

}  // namespace slammot::mcap
