#pragma once

#include <map>
#include <string>
#include <utility>

#include "common/mcap/writer.hpp"

namespace slammot::mcap {

/// Writes message after message into chunks of about a megabyte, in one thread.
class StreamWriter {
 public:
  static constexpr std::size_t kChunkBytes = std::size_t{1} << 20;

  StreamWriter(const std::filesystem::path& path, const Header& header, Compression compression,
               std::size_t chunk_bytes = kChunkBytes);

  /// Ids in this file, from 1 on; the id of an equal one if there is one already.
  SchemaId add(Schema schema);
  ChannelId add(Channel channel);
  /// Its channel is one of add()'s. False on a fault.
  bool add(const MessageHead& head, Bytes data);
  bool write(const Attachment& attachment) { return writer_.write(attachment); }
  bool write(const Metadata& metadata) { return writer_.write(metadata); }
  /// Ends the chunk under way.
  bool flush();
  /// Ends and closes the file.
  bool finish();

  const Statistics& statistics() const { return writer_.statistics(); }
  const std::string& fault() const {
    return writer_.fault().empty() ? file_.fault() : writer_.fault();
  }

 private:
  FileSink file_;
  Writer writer_;
  ChunkBuilder chunk_;
  std::size_t chunk_bytes_;
  std::vector<Schema> schemas_;
  std::vector<Channel> channels_;
};

}  // namespace slammot::mcap
