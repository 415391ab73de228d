#include "common/bags/unpack.hpp"

#include <algorithm>
#include <functional>
#include <memory>

#include <bzlib.h>
#include <lz4frame.h>
#include <zlib.h>
#include <zstd.h>

namespace slammot::bags {
namespace {

constexpr std::size_t kFirstBytes = std::size_t{1} << 16;

/// What one call of a library did.
struct Step {
  enum class State : std::uint8_t { kGoesOn, kFrameEnded, kFailed };
  State state = State::kFailed;
  std::size_t taken = 0;
  std::size_t given = 0;
};

/// Calls step(what is left, room) until all is taken in, nothing goes on, or it becomes too much.
Unpacked unpack_by(const std::function<Step(Bytes, std::span<std::uint8_t>)>& step, Bytes packed,
                   std::size_t most_bytes) {
  Unpacked unpacked;
  std::size_t filled = 0;
  bool frame_ended = false;
  while (true) {
    if (filled == unpacked.bytes.size()) {
      if (filled >= most_bytes) break;
      unpacked.bytes.resize(std::min(most_bytes, std::max(kFirstBytes, 2 * filled)));
    }
    const Step done = step(packed, std::span(unpacked.bytes).subspan(filled));
    if (done.state == Step::State::kFailed) {
      frame_ended = false;
      break;
    }
    packed = packed.subspan(done.taken);
    filled += done.given;
    frame_ended = done.state == Step::State::kFrameEnded;
    if (frame_ended && packed.empty()) break;
    if (done.taken == 0 && done.given == 0) break;
  }
  unpacked.bytes.resize(filled);
  unpacked.is_whole = frame_ended && packed.empty();
  return unpacked;
}

Unpacked unpack_zstd(Bytes packed, std::size_t most_bytes) {
  const std::unique_ptr<ZSTD_DCtx, decltype(&ZSTD_freeDCtx)> context(ZSTD_createDCtx(),
                                                                     &ZSTD_freeDCtx);
  const auto step = [&](Bytes from, std::span<std::uint8_t> room) {
    ZSTD_inBuffer in{from.data(), from.size(), 0};
    ZSTD_outBuffer out{room.data(), room.size(), 0};
    const std::size_t outcome = ZSTD_decompressStream(context.get(), &out, &in);
    if (ZSTD_isError(outcome) != 0) return Step{};
    return Step{outcome == 0 ? Step::State::kFrameEnded : Step::State::kGoesOn, in.pos, out.pos};
  };
  return unpack_by(step, packed, most_bytes);
}

Unpacked unpack_lz4(Bytes packed, std::size_t most_bytes) {
  LZ4F_dctx* made = nullptr;
  if (LZ4F_isError(LZ4F_createDecompressionContext(&made, LZ4F_VERSION)) != 0) return {};
  const std::unique_ptr<LZ4F_dctx, decltype(&LZ4F_freeDecompressionContext)> context(
      made, &LZ4F_freeDecompressionContext);
  const auto step = [&](Bytes from, std::span<std::uint8_t> room) {
    std::size_t taken = from.size();
    std::size_t given = room.size();
    const std::size_t outcome =
        LZ4F_decompress(context.get(), room.data(), &given, from.data(), &taken, nullptr);
    if (LZ4F_isError(outcome) != 0) return Step{};
    return Step{outcome == 0 ? Step::State::kFrameEnded : Step::State::kGoesOn, taken, given};
  };
  return unpack_by(step, packed, most_bytes);
}

Unpacked unpack_bz2(Bytes packed, std::size_t most_bytes) {
  bz_stream stream{};
  if (BZ2_bzDecompressInit(&stream, 0, 0) != BZ_OK) return {};
  const std::unique_ptr<bz_stream, decltype(&BZ2_bzDecompressEnd)> ends(&stream,
                                                                        &BZ2_bzDecompressEnd);
  const auto step = [&](Bytes from, std::span<std::uint8_t> room) {
    constexpr std::size_t kMostAtOnce = std::size_t{1} << 30;
    const std::size_t in = std::min(from.size(), kMostAtOnce);
    const std::size_t out = std::min(room.size(), kMostAtOnce);
    // the library only reads it
    stream.next_in = const_cast<char*>(reinterpret_cast<const char*>(from.data()));
    stream.avail_in = static_cast<unsigned>(in);
    stream.next_out = reinterpret_cast<char*>(room.data());
    stream.avail_out = static_cast<unsigned>(out);
    const int outcome = BZ2_bzDecompress(&stream);
    if (outcome != BZ_OK && outcome != BZ_STREAM_END) return Step{};
    return Step{outcome == BZ_STREAM_END ? Step::State::kFrameEnded : Step::State::kGoesOn,
                in - stream.avail_in, out - stream.avail_out};
  };
  return unpack_by(step, packed, most_bytes);
}

}  // namespace

bool can_unpack(std::string_view compression) {
  return compression.empty() || compression == "none" || compression == "lz4" ||
         compression == "zstd" || compression == "bz2";
}

Unpacked unpack(std::string_view compression, Bytes packed, std::size_t most_bytes) {
  if (compression == "zstd") return unpack_zstd(packed, most_bytes);
  if (compression == "lz4") return unpack_lz4(packed, most_bytes);
  if (compression == "bz2") return unpack_bz2(packed, most_bytes);
  if (!can_unpack(compression) || packed.size() > most_bytes) return {};
  return {{packed.begin(), packed.end()}, true};
}

std::uint32_t crc32_of(Bytes bytes) {
  return static_cast<std::uint32_t>(::crc32_z(0, bytes.data(), bytes.size()));
}

}  // namespace slammot::bags
