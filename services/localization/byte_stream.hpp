#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <type_traits>
#include <vector>

#include <Eigen/Core>

namespace slammot::localization {

/// Appends plain values to a checkpoint.
template <class T>
void put(std::vector<std::byte>& bytes, const T& value) {
  static_assert(std::is_trivially_copyable_v<T>);
  const auto* first = reinterpret_cast<const std::byte*>(&value);
  bytes.insert(bytes.end(), first, first + sizeof(T));
}

template <int kRows, int kColumns>
void put(std::vector<std::byte>& bytes, const Eigen::Matrix<double, kRows, kColumns>& matrix) {
  for (const double coefficient : matrix.reshaped()) put(bytes, coefficient);
}

template <class T>
void put_all(std::vector<std::byte>& bytes, const std::vector<T>& values) {
  static_assert(std::is_trivially_copyable_v<T>);
  put(bytes, static_cast<std::uint64_t>(values.size()));
  const auto* first = reinterpret_cast<const std::byte*>(values.data());
  bytes.insert(bytes.end(), first, first + values.size() * sizeof(T));
}

/// Reads them back; once it has run past the end, every further value is left as it was and ok() is false.
class ByteReader {
 public:
  ByteReader(const std::byte* first, const std::byte* last) : at_(first), end_(last) {}

  bool ok() const { return ok_; }
  bool at_end() const { return at_ == end_; }

  template <class T>
  void get(T& value) {
    static_assert(std::is_trivially_copyable_v<T>);
    if (!has(sizeof(T))) return;
    std::memcpy(&value, at_, sizeof(T));
    at_ += sizeof(T);
  }

  template <int kRows, int kColumns>
  void get(Eigen::Matrix<double, kRows, kColumns>& matrix) {
    for (double& coefficient : matrix.reshaped()) get(coefficient);
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

 private:
  bool has(std::size_t size) {
    ok_ = ok_ && static_cast<std::size_t>(end_ - at_) >= size;
    return ok_;
  }

  const std::byte* at_;
  const std::byte* end_;
  bool ok_ = true;
};

}  // namespace slammot::localization
