#pragma once

#include <bit>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string_view>

namespace slammot::bags {

using Bytes = std::span<const std::uint8_t>;

/// The bytes as text.
inline std::string_view text_of(Bytes bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

/// Takes numbers out of bytes, one after the other. What reaches beyond the end is 0 or empty, and
/// so is all after it: sizes that the bytes name are believed as far as there are bytes.
class ByteReader {
 public:
  explicit ByteReader(Bytes bytes, std::endian order = std::endian::little)
      : bytes_(bytes), swaps_(order != std::endian::native) {}

  template <typename Number>
  requires std::integral<Number> || std::floating_point<Number> Number number() {
    Number value{};
    const Bytes raw = take(sizeof value);
    if (raw.size() != sizeof value) return value;
    std::uint8_t* const into = reinterpret_cast<std::uint8_t*>(&value);
    std::memcpy(into, raw.data(), sizeof value);
    if (swaps_) {
      for (std::size_t i = 0; i < sizeof value / 2; ++i)
        std::swap(into[i], into[sizeof value - 1 - i]);
    }
    return value;
  }

  Bytes take(std::uint64_t count) {
    if (count > left()) {
      is_ok_ = false;
      at_ = bytes_.size();
      return {};
    }
    const Bytes taken = bytes_.subspan(at_, static_cast<std::size_t>(count));
    at_ += taken.size();
    return taken;
  }

  /// A string after its length of 32 bits.
  std::string_view text() { return text_of(take(number<std::uint32_t>())); }

  Bytes rest() { return take(left()); }
  std::size_t left() const { return bytes_.size() - at_; }
  std::size_t position() const { return at_; }
  bool is_ok() const { return is_ok_; }
  void fail() { take(left() + 1); }

 private:
  Bytes bytes_;
  bool swaps_;
  std::size_t at_ = 0;
  bool is_ok_ = true;
};

}  // namespace slammot::bags
