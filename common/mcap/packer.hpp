#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string_view>
#include <vector>

#include "common/bags/byte_reader.hpp"

struct ZSTD_CCtx_s;

namespace slammot::mcap {

enum class Compression : std::uint8_t { kNone, kLz4, kZstd };

/// As a chunk names it (mcap.dev/spec/registry): "", "lz4", "zstd".
std::string_view name_of(Compression compression);

/// Of "none", "lz4" or "zstd"; none for other words.
std::optional<Compression> compression_of(std::string_view word);

/// Packs chunks, each into one frame. Its memory is kept from chunk to chunk.
class Packer {
 public:
  explicit Packer(Compression compression);
  ~Packer();
  Packer(Packer&&) noexcept;

  Compression compression() const { return compression_; }

  /// Valid until the next call, and while `bytes` are. Throws std::runtime_error if the library
  /// fails, which it does only without memory.
  bags::Bytes pack(bags::Bytes bytes);

 private:
  struct Free {
    void operator()(ZSTD_CCtx_s* context) const;
  };

  Compression compression_;
  std::unique_ptr<ZSTD_CCtx_s, Free> context_;  ///< Of zstd only.
  std::vector<std::uint8_t> packed_;
};

}  // namespace slammot::mcap
