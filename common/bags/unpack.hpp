#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "common/bags/byte_reader.hpp"

namespace slammot::bags {

/// Chunks and messages that unpack to more are damaged or meant to do harm.
inline constexpr std::size_t kMostUnpackedBytes = std::size_t{256} << 20;

struct Unpacked {
  std::vector<std::uint8_t> bytes;  ///< As far as it could be unpacked.
  bool is_whole = false;            ///< Whether it ended as it should.
};

/// Whether a chunk with this name of a compression can be unpacked: "", "none", "lz4", "zstd",
/// "bz2".
bool can_unpack(std::string_view compression);

/// Unpacks one or more frames. Memory grows with what comes out, never with what the frames say
/// will; at most most_bytes.
Unpacked unpack(std::string_view compression, Bytes packed,
                std::size_t most_bytes = kMostUnpackedBytes);

/// By IEEE 802.3, as MCAP has it.
std::uint32_t crc32_of(Bytes bytes);

}  // namespace slammot::bags
