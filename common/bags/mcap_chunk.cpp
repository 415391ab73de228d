#include "common/bags/mcap_chunk.hpp"

#include <algorithm>
#include <utility>

#include "common/bags/unpack.hpp"

namespace slammot::bags {

McapChunk unpack_mcap_chunk(Bytes content, McapContent extent) {
  const bool is_whole = extent == McapContent::kWhole;
  McapChunk chunk;
  const auto refuse = [&](const char* fault) {
    chunk.fault = fault;
    return std::move(chunk);
  };
  ByteReader reader(content);
  chunk.start_ns = reader.number<std::int64_t>();
  chunk.end_ns = reader.number<std::int64_t>();
  const auto unpacked_bytes = reader.number<std::uint64_t>();
  const auto crc = reader.number<std::uint32_t>();
  const std::string_view compression = reader.text();
  const auto packed_bytes = reader.number<std::uint64_t>();
  if (!reader.is_ok()) return refuse("is too short");
  if (!can_unpack(compression)) return refuse("is packed in a way that is not known here");
  if (is_whole && packed_bytes > reader.left()) return refuse("is shorter than it says");
  Unpacked unpacked =
      unpack(compression, reader.take(std::min<std::uint64_t>(packed_bytes, reader.left())));
  const bool has_all = unpacked.bytes.size() == unpacked_bytes;
  if (has_all && crc != 0 && crc32_of(unpacked.bytes) != crc) return refuse("fails its checksum");
  chunk.is_sound = is_whole && unpacked.is_whole && has_all;
  if (is_whole && !chunk.is_sound) chunk.fault = "does not unpack to its end";
  chunk.records = std::move(unpacked.bytes);
  return chunk;
}

}  // namespace slammot::bags
