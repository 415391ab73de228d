#pragma once

#include <bit>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>

namespace slammot::gateway {

/// Bytes of a message as ROS 2 serializes it: plain CDR, little-endian, numbers aligned to their
/// size after the header of four bytes (OMG DDSI-RTPS 2.5, section 10).
class CdrWriter {
 public:
  template <typename Number>
  void put(Number value) {
    static_assert(std::is_arithmetic_v<Number> && std::endian::native == std::endian::little);
    bytes_.append((sizeof value - (bytes_.size() - kHeader) % sizeof value) % sizeof value, '\0');
    char raw[sizeof value];
    std::memcpy(raw, &value, sizeof value);
    bytes_.append(raw, sizeof value);
  }

  void put(std::string_view text) {
    put(static_cast<std::uint32_t>(text.size() + 1));
    bytes_ += text;
    bytes_ += '\0';
  }

  /// Of a sequence, before its members.
  void put_count(std::size_t count) { put(static_cast<std::uint32_t>(count)); }

  /// A sequence of bytes.
  void put_bytes(std::string_view bytes) {
    put_count(bytes.size());
    bytes_ += bytes;
  }

  std::string take() && { return std::move(bytes_); }

 private:
  static constexpr std::size_t kHeader = 4;
  std::string bytes_ = std::string("\0\1\0\0", kHeader);
};

}  // namespace slammot::gateway
