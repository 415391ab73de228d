#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "common/bags/byte_reader.hpp"

namespace slammot::bags {

/// The records within a chunk of an MCAP file, or why there are none.
struct McapChunk {
  std::int64_t start_ns = 0;  ///< Log times of its messages; 0 without any.
  std::int64_t end_ns = 0;
  std::vector<std::uint8_t> records;  ///< Unpacked.
  bool is_sound = false;  ///< Unpacked to its end, and its checksum, if it has one, is right.
  std::string fault;      ///< Without a subject: "fails its checksum". Empty for a sound one.
};

/// Whether the content of a chunk record was read to its end.
enum class McapContent : std::uint8_t { kCut, kWhole };

/// Unpacks the content of a chunk record (mcap.dev/spec, op 0x06). Of a cut content the records are
/// unpacked as far as they go; a chunk that fails its checksum has no records.
McapChunk unpack_mcap_chunk(Bytes content, McapContent extent);

}  // namespace slammot::bags
