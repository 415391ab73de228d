#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "common/bags/byte_reader.hpp"

namespace slammot::mcap {

using bags::Bytes;
using ChannelId = std::uint16_t;
using SchemaId = std::uint16_t;

/// Records of an MCAP file (mcap.dev/spec, version 0). Times are nanoseconds since 1970 by the
/// recorder's clock, except where a comment says otherwise.
struct Header {
  std::string profile;
  std::string library;
};

/// Layout of messages.
struct Schema {
  SchemaId id = 0;  ///< Not 0.
  std::string name;
  std::string encoding;  ///< "omgidl", "protobuf", ...
  std::vector<std::uint8_t> data;

  bool operator==(const Schema&) const = default;
};

/// One topic as its writers have it.
struct Channel {
  ChannelId id = 0;
  SchemaId schema_id = 0;  ///< 0: none.
  std::string topic;
  std::string message_encoding;  ///< "cdr", "protobuf", ...
  std::map<std::string, std::string> metadata;

  bool operator==(const Channel&) const = default;
};

struct MessageHead {
  ChannelId channel_id = 0;
  std::uint32_t sequence = 0;  ///< Counts the channel's messages.
  std::int64_t log_time_ns = 0;
  std::int64_t publish_time_ns = 0;  ///< By the writer's clock.
};

struct Attachment {
  std::int64_t log_time_ns = 0;
  std::int64_t create_time_ns = 0;  ///< 0: unknown.
  std::string name;
  std::string media_type;
  std::vector<std::uint8_t> data;
};

struct Metadata {
  std::string name;
  std::map<std::string, std::string> values;
};

/// Where the messages of one channel are in a chunk.
struct MessageIndex {
  struct Entry {
    std::int64_t log_time_ns;
    std::uint64_t offset;  ///< In the unpacked records.
  };
  ChannelId channel_id = 0;
  std::vector<Entry> entries;
};

struct ChunkIndex {
  std::int64_t start_ns = 0;  ///< Log times of its messages.
  std::int64_t end_ns = 0;
  std::uint64_t offset = 0;  ///< Of the chunk record in the file.
  std::uint64_t length = 0;  ///< With opcode and length.
  std::vector<std::pair<ChannelId, std::uint64_t>> index_offsets;  ///< In the file.
  std::uint64_t indexes_length = 0;
  std::string compression;
  std::uint64_t packed_bytes = 0;
  std::uint64_t unpacked_bytes = 0;
};

struct AttachmentIndex {
  std::uint64_t offset = 0;
  std::uint64_t length = 0;
  std::int64_t log_time_ns = 0;
  std::int64_t create_time_ns = 0;
  std::uint64_t data_bytes = 0;
  std::string name;
  std::string media_type;
};

struct MetadataIndex {
  std::uint64_t offset = 0;
  std::uint64_t length = 0;
  std::string name;
};

struct Statistics {
  std::uint64_t message_count = 0;
  std::uint16_t schema_count = 0;
  std::uint32_t channel_count = 0;
  std::uint32_t attachment_count = 0;
  std::uint32_t metadata_count = 0;
  std::uint32_t chunk_count = 0;
  std::int64_t start_ns = 0;  ///< Log times of all messages.
  std::int64_t end_ns = 0;
  std::map<ChannelId, std::uint64_t> messages_of;

  bool operator==(const Statistics&) const = default;
};

struct SummaryOffset {
  std::uint8_t opcode = 0;
  std::uint64_t start = 0;
  std::uint64_t length = 0;
};

struct Footer {
  std::uint64_t summary_start = 0;  ///< 0: no summary.
  std::uint64_t offsets_start = 0;
  std::uint32_t summary_crc = 0;
};

/// Append a whole record: opcode, length, content.
using Buffer = std::vector<std::uint8_t>;
void append(const Header& header, Buffer& into);
void append(const Schema& schema, Buffer& into);
void append(const Channel& channel, Buffer& into);
void append(const MessageHead& head, Bytes data, Buffer& into);
void append(const Attachment& attachment, Buffer& into);
void append(const Metadata& metadata, Buffer& into);
void append(const MessageIndex& index, Buffer& into);
void append(const ChunkIndex& index, Buffer& into);
void append(const AttachmentIndex& index, Buffer& into);
void append(const MetadataIndex& index, Buffer& into);
void append(const Statistics& statistics, Buffer& into);
void append(const SummaryOffset& offset, Buffer& into);
void append(const Footer& footer, Buffer& into);
void append_data_end(std::uint32_t data_crc, Buffer& into);

/// Read the content of a record. None if it is too short, or damaged (attachments).
std::optional<Header> read_header(Bytes content);
std::optional<Schema> read_schema(Bytes content);
std::optional<Channel> read_channel(Bytes content);
std::optional<MessageHead> read_message_head(Bytes content);
std::optional<Attachment> read_attachment(Bytes content);
std::optional<Metadata> read_metadata(Bytes content);
std::optional<MessageIndex> read_message_index(Bytes content);
std::optional<ChunkIndex> read_chunk_index(Bytes content);
std::optional<AttachmentIndex> read_attachment_index(Bytes content);
std::optional<MetadataIndex> read_metadata_index(Bytes content);
std::optional<Statistics> read_statistics(Bytes content);
std::optional<Footer> read_footer(Bytes content);

/// CRC-32 of IEEE 802.3, continued from that of the bytes before.
std::uint32_t crc32(Bytes bytes, std::uint32_t before = 0);

}  // namespace slammot::mcap
