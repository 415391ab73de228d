#pragma once

#include <map>
#include <vector>

#include "common/mcap/chunk_builder.hpp"
#include "common/mcap/file_sink.hpp"
#include "common/mcap/packer.hpp"
#include "common/mcap/records.hpp"

namespace slammot::mcap {

/// Writes an MCAP file (mcap.dev/spec, version 0) with chunks, message indexes, attachments,
/// metadata, a summary with statistics and offsets, and all checksums. On a fault the file is cut
/// to its last whole record, and nothing more is written but the end.
class Writer {
 public:
  /// Begins the file.
  Writer(FileSink& file, const Header& header, Compression compression);

  /// Writes the chunk and its indexes. Schemas and channels of the chunk are repeated in the
  /// summary. False on a fault.
  bool write(const ChunkBuilder& chunk);
  bool write(const Attachment& attachment);
  bool write(const Metadata& metadata);
  /// A chunk as it is in another file, without unpacking it; `indexes` and the others describe its
  /// content. Its channels must be known here.
  bool write_packed(Bytes chunk_record, const ChunkIndex& as_it_was,
                    std::span<const MessageIndex> indexes);
  void know(const Schema& schema);
  void know(const Channel& channel);

  /// Writes data end, summary, summary offsets and footer, also after a fault. False if they do not
  /// fit either: the file ends after its last whole record then.
  bool finish();

  const Statistics& statistics() const { return statistics_; }
  /// What stopped the writing; empty if nothing did.
  const std::string& fault() const { return fault_; }

 private:
  bool put(Bytes bytes);
  bool put_record();
  bool put_chunk(ChunkIndex index, std::span<const MessageIndex> indexes);
  void count(const ChunkIndex& chunk, std::span<const MessageIndex> indexes);
  template <typename Records>
  void append_group(const Records& records, std::uint8_t opcode, std::uint64_t summary_start);
  void append_summary(std::uint64_t summary_start);

  FileSink& file_;
  Packer packer_;
  Buffer buffer_;
  std::uint32_t data_crc_ = 0;
  std::string fault_;
  Statistics statistics_;
  std::map<SchemaId, Schema> schemas_;
  std::map<ChannelId, Channel> channels_;
  std::vector<ChunkIndex> chunks_;
  std::vector<AttachmentIndex> attachments_;
  std::vector<MetadataIndex> metadata_;
  std::vector<SummaryOffset> offsets_;
};

}  // namespace slammot::mcap
