#pragma once

#include <filesystem>
#include <memory>
#include <optional>

#include "common/bags/mcap_chunk.hpp"
#include "common/files/result.hpp"
#include "common/mcap/contents.hpp"

namespace slammot::mcap {

/// The bytes of an MCAP file at any place.
class FileBytes {
 public:
  explicit FileBytes(const std::filesystem::path& path);
  ~FileBytes();
  FileBytes(const FileBytes&) = delete;
  FileBytes& operator=(const FileBytes&) = delete;

  bool is_open() const { return file_ >= 0; }
  std::uint64_t size() const { return size_; }
  /// Fewer than so many at the end of the file.
  Buffer read(std::uint64_t offset, std::uint64_t count) const;

 private:
  int file_;
  std::uint64_t size_ = 0;
};

/// An MCAP file of which any part can be read. Its messages are read by a MessageCursor.
class File {
 public:
  /// Reads the summary at the file's end, or, where there is none (a recording that a crash cut),
  /// all records. An error if it is no MCAP file.
  static files::Result<File> open(const std::filesystem::path& path);
  /// Reads all records, and compares the summary with them.
  static files::Result<File> open_and_verify(const std::filesystem::path& path);

  const Contents& contents() const { return contents_; }
  std::uint64_t size_bytes() const { return bytes_->size(); }

  bags::McapChunk chunk(const ChunkIndex& index) const;
  /// The whole record, as it is in the file.
  Buffer chunk_record(const ChunkIndex& index) const;
  /// None if it is damaged.
  std::optional<Attachment> attachment(const AttachmentIndex& index) const;
  std::optional<Metadata> metadata(const MetadataIndex& index) const;

 private:
  File(std::unique_ptr<FileBytes> bytes, Contents contents)
      : bytes_(std::move(bytes)), contents_(std::move(contents)) {}

  std::unique_ptr<FileBytes> bytes_;
  Contents contents_;
};

/// Message indexes of a chunk, from its unpacked records. Messages of unknown channels are in it,
/// too.
std::vector<MessageIndex> indexes_of(Bytes records);

}  // namespace slammot::mcap
