#include "common/mcap/file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

#include "common/bags/mcap_format.hpp"
#include "common/bags/unpack.hpp"
#include "common/mcap/scan.hpp"

namespace slammot::mcap {
namespace {

namespace format = bags::mcap_format;

/// Content of the record at this place, if it is such a one.
std::optional<Buffer> content_at(const FileBytes& bytes, std::uint64_t offset, std::uint64_t length,
                                 std::uint8_t opcode) {
  if (length < format::kRecordHeadBytes || length > bags::kMostUnpackedBytes) return std::nullopt;
  Buffer record = bytes.read(offset, length);
  bags::ByteReader head(record);
  if (record.size() != length || head.number<std::uint8_t>() != opcode ||
      head.number<std::uint64_t>() != length - format::kRecordHeadBytes)
    return std::nullopt;
  record.erase(record.begin(), record.begin() + format::kRecordHeadBytes);
  return record;
}

/// Checksum of all bytes before this place.
std::uint32_t crc32_until(const FileBytes& bytes, std::uint64_t end) {
  constexpr std::uint64_t kStep = std::uint64_t{1} << 20;
  std::uint32_t crc = 0;
  for (std::uint64_t at = 0; at < end; at += kStep)
    crc = crc32(bytes.read(at, std::min(kStep, end - at)), crc);
  return crc;
}

std::vector<std::string> differences(const Contents& summary, const Contents& found) {
  std::vector<std::string> all;
  const auto compare = [&](bool is_same, const char* what) {
    if (!is_same) all.push_back(std::string("the summary differs from the records in ") + what);
  };
  const auto places = [](const Contents& contents) {
    std::vector<std::pair<std::uint64_t, std::uint64_t>> of_chunks;
    for (const ChunkIndex& chunk : contents.chunks)
      of_chunks.emplace_back(chunk.offset, chunk.length);
    return of_chunks;
  };
  compare(summary.schemas == found.schemas, "its schemas");
  compare(summary.channels == found.channels, "its channels");
  compare(places(summary) == places(found), "its chunks");
  compare(summary.statistics == found.statistics || summary.statistics == Statistics{},
          "its statistics");
  return all;
}

}  // namespace

FileBytes::FileBytes(const std::filesystem::path& path)
    : file_(::open(path.c_str(), O_RDONLY | O_CLOEXEC)) {
  struct stat status {};
  if (file_ >= 0 && ::fstat(file_, &status) == 0 && S_ISREG(status.st_mode))
    size_ = static_cast<std::uint64_t>(status.st_size);
}

FileBytes::~FileBytes() {
  if (file_ >= 0) ::close(file_);
}

Buffer FileBytes::read(std::uint64_t offset, std::uint64_t count) const {
  Buffer bytes(static_cast<std::size_t>(offset < size_ ? std::min(count, size_ - offset)
                                                       : std::uint64_t{0}));
  std::size_t filled = 0;
  while (filled < bytes.size()) {
    const ssize_t got = ::pread(file_, bytes.data() + filled, bytes.size() - filled,
                                static_cast<off_t>(offset + filled));
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) break;
    filled += static_cast<std::size_t>(got);
  }
  bytes.resize(filled);
  return bytes;
}

files::Result<File> File::open(const std::filesystem::path& path) {
  auto bytes = std::make_unique<FileBytes>(path);
  if (!bytes->is_open()) return files::Error{path.string() + ": " + std::strerror(errno)};
  if (bags::text_of(bytes->read(0, format::kMagic.size())) != format::kMagic)
    return files::Error{path.string() + " is not an MCAP file"};
  auto summary = read_summary(*bytes);
  const bool is_empty =
      summary && summary->statistics != Statistics{} && summary->statistics.message_count == 0;
  const bool has_index = summary && (!summary->chunks.empty() || is_empty);
  Contents contents = has_index ? *std::move(summary) : scan(*bytes);
  return File(std::move(bytes), std::move(contents));
}

files::Result<File> File::open_and_verify(const std::filesystem::path& path) {
  auto file = open(path);
  if (!file) return file;
  const Contents summary = std::move(file->contents_);
  Contents found = scan(*file->bytes_);
  if (!summary.is_whole) {
    if (found.damage.empty()) found.damage.emplace_back("the file has no sound summary");
  } else {
    const std::uint32_t crc = crc32_until(*file->bytes_, found.end_of_data);
    if (found.data_crc != 0 && found.data_crc != crc)
      found.damage.emplace_back("the data section fails its checksum");
    std::ranges::copy(differences(summary, found), std::back_inserter(found.damage));
  }
  found.is_whole = summary.is_whole;
  file->contents_ = std::move(found);
  return file;
}

bags::McapChunk File::chunk(const ChunkIndex& index) const {
  const auto content = content_at(*bytes_, index.offset, index.length, format::kChunk);
  if (content) return bags::unpack_mcap_chunk(*content, bags::McapContent::kWhole);
  bags::McapChunk none;
  none.fault = "is not where the index says";
  return none;
}

Buffer File::chunk_record(const ChunkIndex& index) const {
  return bytes_->read(index.offset, index.length);
}

std::optional<Attachment> File::attachment(const AttachmentIndex& index) const {
  const auto content = content_at(*bytes_, index.offset, index.length, format::kAttachment);
  return content ? read_attachment(*content) : std::nullopt;
}

std::optional<Metadata> File::metadata(const MetadataIndex& index) const {
  const auto content = content_at(*bytes_, index.offset, index.length, format::kMetadata);
  return content ? read_metadata(*content) : std::nullopt;
}

std::vector<MessageIndex> indexes_of(Bytes records) {
  std::vector<MessageIndex> indexes;
  for_each_record(records, [&](std::uint8_t opcode, Bytes content) {
    const auto head = opcode == format::kMessage ? read_message_head(content) : std::nullopt;
    if (!head) return;
    auto index = std::ranges::find(indexes, head->channel_id, &MessageIndex::channel_id);
    if (index == indexes.end()) index = indexes.insert(indexes.end(), {head->channel_id, {}});
    const auto offset = static_cast<std::uint64_t>(content.data() - records.data());
    index->entries.push_back({head->log_time_ns, offset - format::kRecordHeadBytes});
  });
  return indexes;
}

}  // namespace slammot::mcap
