#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <optional>
#include <span>
#include <type_traits>
#include <vector>

#include <Eigen/Core>

namespace slammot::memory {

inline void put_bytes(std::vector<std::byte>& bytes, const void* first, std::size_t count) {
  const std::size_t end = bytes.size();
  bytes.resize(end + count);
  if (count > 0) std::memcpy(bytes.data() + end, first, count);
}

/// Appends plain values to a checkpoint. Not for structs with padding: its bytes would be others
/// every time.
template <class T>
void put(std::vector<std::byte>& bytes, const T& value) {
  static_assert(std::is_trivially_copyable_v<T>);
  put_bytes(bytes, &value, sizeof(T));
}

template <int kRows, int kColumns>
void put(std::vector<std::byte>& bytes, const Eigen::Matrix<double, kRows, kColumns>& matrix) {
  for (const double coefficient : matrix.reshaped()) put(bytes, coefficient);
}

template <class T>
void put(std::vector<std::byte>& bytes, const std::optional<T>& value) {
  put(bytes, value.has_value());
  put(bytes, value.value_or(T{}));
}

template <class T>
void put_all(std::vector<std::byte>& bytes, const std::vector<T>& values) {
  static_assert(std::is_trivially_copyable_v<T>);
  put(bytes, static_cast<std::uint64_t>(values.size()));
  put_bytes(bytes, values.data(), values.size() * sizeof(T));
}

/// The first cell that is not zero, or the end: most are skipped eight at a time.
template <class T>
auto first_set(typename std::vector<T>::const_iterator at,
               typename std::vector<T>::const_iterator end) {
  constexpr std::ptrdiff_t kWord = sizeof(std::uint64_t);
  for (; end - at >= kWord; at += kWord) {
    std::uint64_t word = 0;
    std::memcpy(&word, &*at, sizeof word);
    if (word != 0) break;
  }
  return std::find_if(at, end, [](T cell) { return cell != 0; });
}

/// Appends the cells of a grid, of which most are zero: in turn the number of zeros, and a number
/// of other cells with these. Short gaps of zeros count as others.
template <class T>
void put_cells(std::vector<std::byte>& bytes, const std::vector<T>& cells) {
  static_assert(std::is_integral_v<T> && sizeof(T) == 1);
  constexpr std::ptrdiff_t kShortestGap = 16;
  put(bytes, static_cast<std::uint64_t>(cells.size()));
  for (auto at = cells.begin(); at != cells.end();) {
    const auto first = first_set<T>(at, cells.end());
    auto end = first;
    for (auto next = first; next != cells.end() && next - end < kShortestGap; ++next) {
      if (*next != 0) end = next + 1;
    }
    put(bytes, static_cast<std::uint64_t>(first - at));
    put(bytes, static_cast<std::uint64_t>(end - first));
    if (first != end) put_bytes(bytes, &*first, static_cast<std::size_t>(end - first));
    at = end;
  }
}

/// Reads them back; once it has run past the end, every further value is left as it was and ok() is
/// false.
class ByteReader {
 public:
  explicit ByteReader(std::span<const std::byte> bytes)
      : at_(bytes.data()), end_(bytes.data() + bytes.size()) {}

  bool ok() const { return ok_; }
  bool at_end() const { return at_ == end_; }
  std::size_t left() const { return static_cast<std::size_t>(end_ - at_); }
  /// What was read cannot be right.
  void refuse() { ok_ = false; }

  void get_bytes(void* to, std::size_t count) {
    if (!has(count)) return;
    if (count > 0) std::memcpy(to, at_, count);
    at_ += count;
  }

  template <class T>
  void get(T& value) {
    static_assert(std::is_trivially_copyable_v<T>);
    get_bytes(&value, sizeof(T));
  }

  /// Any byte but 0 is true: a bool made of other bytes would be undefined.
  void get(bool& value) {
    std::uint8_t byte = value ? 1 : 0;
    get(byte);
    value = byte != 0;
  }

  template <int kRows, int kColumns>
  void get(Eigen::Matrix<double, kRows, kColumns>& matrix) {
    for (double& coefficient : matrix.reshaped()) get(coefficient);
  }

  template <class T>
  void get(std::optional<T>& value) {
    bool has_value = value.has_value();
    T read = value.value_or(T{});
    get(has_value);
    get(read);
    value = has_value ? std::optional(read) : std::nullopt;
  }

  template <class T>
  void get_all(std::vector<T>& values) {
    std::uint64_t count = 0;
    get(count);
    if (!ok_ || count > static_cast<std::uint64_t>(end_ - at_) / sizeof(T)) {
      ok_ = false;
      return;
    }
    values.resize(count);
    if (count > 0) std::memcpy(values.data(), at_, count * sizeof(T));
    at_ += count * sizeof(T);
  }

  /// Of put_cells(). More than `most` cells cannot be right.
  template <class T>
  void get_cells(std::vector<T>& cells, std::size_t most) {
    std::uint64_t count = 0;
    get(count);
    if (count > most) refuse();
    if (!ok_) return;
    cells.assign(count, T{0});
    for (std::uint64_t done = 0; ok_ && done < count;) {
      std::uint64_t zeros = 0;
      std::uint64_t others = 0;
      get(zeros);
      get(others);
      const bool fits = zeros <= count - done && others <= count - done - zeros;
      if (!fits || zeros + others == 0) return refuse();
      get_bytes(cells.data() + done + zeros, others);
      done += zeros + others;
    }
  }

 private:
  bool has(std::size_t size) {
    ok_ = ok_ && static_cast<std::size_t>(end_ - at_) >= size;
    return ok_;
  }

  const std::byte* at_;
  const std::byte* end_;
  bool ok_ = true;
};

/// Checksum of bytes, eight at a time: FNV-1a over 64-bit words, Fowler, Noll and Vo 1991. Against
/// damage, not against malice.
inline std::uint64_t checksum(std::span<const std::byte> bytes) {
  std::uint64_t sum = 0xcbf29ce484222325U;
  for (std::size_t done = 0; done < bytes.size(); done += sizeof(std::uint64_t)) {
    std::uint64_t word = 0;
    std::memcpy(&word, bytes.data() + done, std::min(sizeof word, bytes.size() - done));
    sum = (sum ^ word) * 0x100000001b3U;
  }
  return sum;
}

/// What stands before the checksum that ends the bytes; none when it does not fit.
inline std::optional<std::span<const std::byte>> unsealed(std::span<const std::byte> bytes) {
  std::uint64_t sum = 0;
  if (bytes.size() < sizeof sum) return std::nullopt;
  const auto content = bytes.first(bytes.size() - sizeof sum);
  std::memcpy(&sum, bytes.data() + content.size(), sizeof sum);
  if (sum != checksum(content)) return std::nullopt;
  return content;
}

}  // namespace slammot::memory
