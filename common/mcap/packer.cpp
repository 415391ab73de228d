#include "common/mcap/packer.hpp"

#include <stdexcept>

#include <lz4frame.h>
#include <zstd.h>

namespace slammot::mcap {
namespace {

/// The fastest of zstd's regular levels: the bench of the recorder shows its share of a core.
constexpr int kZstdLevel = 1;

std::size_t checked(std::size_t outcome, bool is_error) {
  if (is_error) throw std::runtime_error("a chunk could not be packed");
  return outcome;
}

}  // namespace

std::string_view name_of(Compression compression) {
  if (compression == Compression::kLz4) return "lz4";
  return compression == Compression::kZstd ? "zstd" : "";
}

std::optional<Compression> compression_of(std::string_view word) {
  if (word == "none") return Compression::kNone;
  if (word == "lz4") return Compression::kLz4;
  if (word == "zstd") return Compression::kZstd;
  return std::nullopt;
}

void Packer::Free::operator()(ZSTD_CCtx_s* context) const { ZSTD_freeCCtx(context); }

Packer::Packer(Compression compression) : compression_(compression) {
  if (compression == Compression::kZstd) context_.reset(ZSTD_createCCtx());
}

Packer::~Packer() = default;
Packer::Packer(Packer&&) noexcept = default;

bags::Bytes Packer::pack(bags::Bytes bytes) {
  if (compression_ == Compression::kNone) return bytes;
  const bool is_lz4 = compression_ == Compression::kLz4;
  packed_.resize(is_lz4 ? LZ4F_compressFrameBound(bytes.size(), nullptr)
                        : ZSTD_compressBound(bytes.size()));
  const std::size_t outcome =
      is_lz4
          ? LZ4F_compressFrame(packed_.data(), packed_.size(), bytes.data(), bytes.size(), nullptr)
          : ZSTD_compressCCtx(context_.get(), packed_.data(), packed_.size(), bytes.data(),
                              bytes.size(), kZstdLevel);
  const bool is_error = is_lz4 ? LZ4F_isError(outcome) != 0 : ZSTD_isError(outcome) != 0;
  return bags::Bytes(packed_).first(checked(outcome, is_error));
}

}  // namespace slammot::mcap
