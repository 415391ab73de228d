#include "services/map_store/blob.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include <zlib.h>

namespace slammot::map_store {
namespace {

constexpr int kDeflateLevel = 6;
/// Greater than any record; limits the allocation for a damaged blob.
constexpr std::size_t kMaxRecordBytes = std::size_t{256} << 20;
/// No zlib stream holds more than 1032 times its own length.
constexpr std::size_t kMaxDeflateRatio = 1032;

}  // namespace

std::string deflated(std::string_view record) {
  uLongf written = compressBound(record.size());
  std::string blob(4 + written, '\0');
  for (std::size_t i = 0; i < 4; ++i) blob[i] = static_cast<char>(record.size() >> (8 * i) & 0xFF);
  compress2(reinterpret_cast<Bytef*>(blob.data() + 4), &written,
            reinterpret_cast<const Bytef*>(record.data()), record.size(),
            kDeflateLevel);  // cannot fail: the buffer has the size given by compressBound()
  blob.resize(4 + written);
  return blob;
}

std::optional<std::string> inflated(std::string_view blob) {
  if (blob.size() < 4) return std::nullopt;
  std::size_t length = 0;
  for (int i = 3; i >= 0; --i)
    length = length << 8 | static_cast<std::uint8_t>(blob[static_cast<std::size_t>(i)]);
  if (length > std::min(kMaxRecordBytes, kMaxDeflateRatio * blob.size())) return std::nullopt;
  std::string bytes(length, '\0');
  uLongf written = length;
  const int result = uncompress(reinterpret_cast<Bytef*>(bytes.data()), &written,
                                reinterpret_cast<const Bytef*>(blob.data() + 4), blob.size() - 4);
  if (result != Z_OK || written != length) return std::nullopt;
  return bytes;
}

}  // namespace slammot::map_store
