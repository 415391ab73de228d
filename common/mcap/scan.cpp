#include "common/mcap/scan.hpp"

#include <algorithm>

#include "common/bags/mcap_format.hpp"
#include "common/bags/unpack.hpp"

namespace slammot::mcap {
namespace {

namespace format = bags::mcap_format;
using bags::ByteReader;

template <typename Record>
void keep(std::optional<Record> record, std::vector<Record>& in) {
  if (record) in.push_back(*std::move(record));
}

/// The first one of an id counts: two records with one id must be the same.
template <typename Record>
void keep(std::optional<Record> record, std::map<std::uint16_t, Record>& in) {
  if (record) in.emplace(record->id, *record);
}

void take_from_summary(std::uint8_t opcode, Bytes content, Contents& contents) {
  if (opcode == format::kSchema) keep(read_schema(content), contents.schemas);
  if (opcode == format::kChannel) keep(read_channel(content), contents.channels);
  if (opcode == format::kChunkIndex) keep(read_chunk_index(content), contents.chunks);
  if (opcode == format::kAttachmentIndex)
    keep(read_attachment_index(content), contents.attachments);
  if (opcode == format::kMetadataIndex) keep(read_metadata_index(content), contents.metadata);
  if (opcode == format::kStatistics)
    contents.statistics = read_statistics(content).value_or(Statistics{});
}

Bytes content_of(const Buffer& record) { return Bytes(record).subspan(format::kRecordHeadBytes); }

/// Reads the records of a file one after the other.
class Scan {
 public:
  explicit Scan(const FileBytes& bytes) : bytes_(bytes) {}

  Contents run() {
    const Buffer begin = bytes_.read(0, format::kMagic.size());
    if (bags::text_of(begin) != format::kMagic) {
      note(0, "the file does not begin as an MCAP file does");
      return std::move(contents_);
    }
    contents_.end_of_data = at_ = begin.size();
    while (read_record()) contents_.end_of_data = at_;
    count();
    return std::move(contents_);
  }

 private:
  void note(std::uint64_t at, const std::string& what) {
    contents_.damage.push_back("byte " + std::to_string(at) + ": " + what);
  }

  /// False at the data end, or where the records end.
  bool read_record() {
    const Buffer head = bytes_.read(at_, format::kRecordHeadBytes);
    ByteReader reader(head);
    const auto opcode = reader.number<std::uint8_t>();
    const auto length = reader.number<std::uint64_t>();
    if (!reader.is_ok()) return note(at_, "the file ends without a data end"), false;
    if (!format::is_opcode(opcode)) return note(at_, "no record begins here"), false;
    if (length > bytes_.size() - at_ - head.size())
      return note(at_, "the file ends in a record"), false;
    const std::uint64_t whole = head.size() + length;
    if (opcode == format::kDataEnd) {
      const Buffer record = bytes_.read(at_, whole);
      contents_.data_crc = ByteReader(content_of(record)).number<std::uint32_t>();
      return false;
    }
    take(opcode, whole);
    at_ += whole;
    return true;
  }

  void take(std::uint8_t opcode, std::uint64_t whole) {
    if (opcode == format::kMessage) ++contents_.loose_messages;
    const bool is_of_use = opcode == format::kHeader || opcode == format::kSchema ||
                           opcode == format::kChannel || opcode == format::kChunk ||
                           opcode == format::kAttachment || opcode == format::kMetadata;
    if (!is_of_use) return;
    if (whole > bags::kMostUnpackedBytes) return note(at_, "the record is too long");
    const Buffer record = bytes_.read(at_, whole);
    const Bytes content = content_of(record);
    if (opcode == format::kHeader) contents_.header = read_header(content).value_or(Header{});
    if (opcode == format::kSchema || opcode == format::kChannel)
      take_from_summary(opcode, content, contents_);
    if (opcode == format::kChunk) take_chunk(content, whole);
    if (opcode == format::kAttachment) take_attachment(content, whole);
    if (opcode == format::kMetadata) take_metadata(content, whole);
  }

  void take_chunk(Bytes content, std::uint64_t whole) {
    const bags::McapChunk chunk = bags::unpack_mcap_chunk(content, bags::McapContent::kWhole);
    if (!chunk.is_sound) return note(at_, "the chunk " + chunk.fault);
    ChunkIndex index{.start_ns = chunk.start_ns,
                     .end_ns = chunk.end_ns,
                     .offset = at_,
                     .length = whole,
                     .index_offsets = {},
                     .compression = {},
                     .packed_bytes = 0,
                     .unpacked_bytes = chunk.records.size()};
    ByteReader reader(content);
    reader.take(28);
    index.compression = reader.text();
    index.packed_bytes = reader.number<std::uint64_t>();
    for_each_record(chunk.records, [&](std::uint8_t opcode, Bytes inner) {
      if (opcode == format::kSchema || opcode == format::kChannel)
        take_from_summary(opcode, inner, contents_);
    });
    count_messages(chunk);
    contents_.chunks.push_back(std::move(index));
  }

  void count_messages(const bags::McapChunk& chunk) {
    Statistics& statistics = contents_.statistics;
    for (const MessageIndex& channel : indexes_of(chunk.records)) {
      for (const MessageIndex::Entry& entry : channel.entries) {
        const bool is_first = statistics.message_count++ == 0;
        statistics.start_ns =
            is_first ? entry.log_time_ns : std::min(statistics.start_ns, entry.log_time_ns);
        statistics.end_ns =
            is_first ? entry.log_time_ns : std::max(statistics.end_ns, entry.log_time_ns);
      }
      statistics.messages_of[channel.channel_id] += channel.entries.size();
    }
  }

  void take_attachment(Bytes content, std::uint64_t whole) {
    const auto attachment = read_attachment(content);
    if (!attachment) return note(at_, "the attachment is damaged");
    contents_.attachments.push_back({at_, whole, attachment->log_time_ns,
                                     attachment->create_time_ns, attachment->data.size(),
                                     attachment->name, attachment->media_type});
  }

  void take_metadata(Bytes content, std::uint64_t whole) {
    const auto metadata = read_metadata(content);
    if (!metadata) return note(at_, "the metadata is damaged");
    contents_.metadata.push_back({at_, whole, metadata->name});
  }

  void count() {
    Statistics& statistics = contents_.statistics;
    statistics.schema_count = static_cast<std::uint16_t>(contents_.schemas.size());
    statistics.channel_count = static_cast<std::uint32_t>(contents_.channels.size());
    statistics.chunk_count = static_cast<std::uint32_t>(contents_.chunks.size());
    statistics.attachment_count = static_cast<std::uint32_t>(contents_.attachments.size());
    statistics.metadata_count = static_cast<std::uint32_t>(contents_.metadata.size());
    if (contents_.loose_messages > 0)
      contents_.damage.push_back(std::to_string(contents_.loose_messages) +
                                 " messages are outside of chunks and left out");
  }

  const FileBytes& bytes_;
  std::uint64_t at_ = 0;
  Contents contents_;
};

/// The footer, if the file ends as an MCAP file does.
std::optional<Footer> footer_of(const FileBytes& bytes) {
  constexpr std::uint64_t kEndBytes =
      format::kRecordHeadBytes + format::kFooterBytes + format::kMagic.size();
  if (bytes.size() < kEndBytes + format::kMagic.size()) return std::nullopt;
  const Buffer end = bytes.read(bytes.size() - kEndBytes, kEndBytes);
  if (end.size() != kEndBytes || !bags::text_of(end).ends_with(format::kMagic) ||
      end.front() != format::kFooter)
    return std::nullopt;
  return read_footer(content_of(end).first(format::kFooterBytes));
}

}  // namespace

void for_each_record(Bytes records,
                     const std::function<void(std::uint8_t opcode, Bytes content)>& handle) {
  ByteReader reader(records);
  while (reader.left() > 0) {
    const auto opcode = reader.number<std::uint8_t>();
    const Bytes content = reader.take(reader.number<std::uint64_t>());
    if (!reader.is_ok()) return;
    handle(opcode, content);
  }
}

std::optional<Contents> read_summary(const FileBytes& bytes) {
  const auto footer = footer_of(bytes);
  if (!footer || footer->summary_start == 0 || footer->summary_start >= bytes.size())
    return std::nullopt;
  const Buffer end = bytes.read(footer->summary_start, bytes.size() - footer->summary_start);
  constexpr std::size_t kUnchecked = sizeof footer->summary_crc + format::kMagic.size();
  if (end.size() < kUnchecked) return std::nullopt;
  const std::uint32_t crc = crc32(Bytes(end).first(end.size() - kUnchecked));
  if (footer->summary_crc != 0 && footer->summary_crc != crc) return std::nullopt;
  Contents contents;
  const Buffer begin =
      bytes.read(0, std::min<std::uint64_t>(footer->summary_start, std::uint64_t{1} << 16));
  for_each_record(Bytes(begin).subspan(std::min(begin.size(), format::kMagic.size())),
                  [&](std::uint8_t opcode, Bytes content) {
                    if (opcode == format::kHeader)
                      contents.header = read_header(content).value_or(Header{});
                  });
  for_each_record(end, [&](std::uint8_t opcode, Bytes content) {
    take_from_summary(opcode, content, contents);
  });
  contents.is_whole = true;
  contents.end_of_data = footer->summary_start;
  return contents;
}

Contents scan(const FileBytes& bytes) { return Scan(bytes).run(); }

}  // namespace slammot::mcap
