#pragma once

#include <concepts>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "common/bags/byte_reader.hpp"

namespace slammot::mcap {

using bags::Bytes;

/// Appends values as MCAP serializes them (mcap.dev/spec, "Serialization"): little endian, strings
/// and byte strings after their length.
class ByteWriter {
 public:
  explicit ByteWriter(std::vector<std::uint8_t>& into) : into_(into) {}

  template <std::integral Number>
  ByteWriter& number(Number value) {
    auto bits = static_cast<std::make_unsigned_t<Number>>(value);
    for (std::size_t i = 0; i < sizeof value; ++i) {
      into_.push_back(static_cast<std::uint8_t>(bits));
      if constexpr (sizeof value > 1) bits >>= 8;
    }
    return *this;
  }

  ByteWriter& raw(Bytes bytes) {
    into_.insert(into_.end(), bytes.begin(), bytes.end());
    return *this;
  }

  ByteWriter& text(std::string_view text) {
    number(static_cast<std::uint32_t>(text.size()));
    return raw({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
  }

  ByteWriter& texts(const std::map<std::string, std::string>& texts) {
    const std::size_t length_at = into_.size();
    number(std::uint32_t{0});
    for (const auto& [key, value] : texts) text(key).text(value);
    return length_of_rest<std::uint32_t>(length_at);
  }

  /// Puts the number of bytes after a length at this place into it.
  template <std::unsigned_integral Length>
  ByteWriter& length_of_rest(std::size_t length_at) {
    auto length = static_cast<Length>(into_.size() - length_at - sizeof(Length));
    for (std::size_t i = 0; i < sizeof length; ++i, length = static_cast<Length>(length >> 8))
      into_[length_at + i] = static_cast<std::uint8_t>(length);
    return *this;
  }

 private:
  std::vector<std::uint8_t>& into_;
};

}  // namespace slammot::mcap
