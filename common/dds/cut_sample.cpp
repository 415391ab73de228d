#include "common/dds/cut_sample.hpp"

#include <array>
#include <cstring>

#include <dds/dds.h>
#include <dds/ddsi/ddsi_serdata.h>

namespace slammot::dds {
namespace {

constexpr std::uint8_t kDelimited = 0x08;  // D_CDR2; one more: little-endian

/// Bytes after the delimiter, by the delimiter; none if the sample has none. The library has
/// converted the sample to this computer's byte order.
std::uint32_t delimited_bytes(const ddsi_serdata* serialized) {
  std::array<std::uint8_t, 8> head{};
  if (ddsi_serdata_size(serialized) < head.size()) return 0;
  ddsi_serdata_to_ser(serialized, 0, head.size(), head.data());
  if ((head[1] & ~1U) != kDelimited) return 0;
  std::uint32_t bytes = 0;
  std::memcpy(&bytes, head.data() + 4, sizeof bytes);
  return bytes;
}

}  // namespace

bool read_whole(const ddsi_serdata* serialized, std::uint32_t least_bytes, void* into) {
  return delimited_bytes(serialized) >= least_bytes &&
         ddsi_serdata_to_sample(serialized, into, nullptr, nullptr);
}

}  // namespace slammot::dds
