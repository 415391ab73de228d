#pragma once

#include <array>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include <Eigen/Core>

#include "common/memory/byte_stream.hpp"
#include "common/memory/recycling_queue.hpp"

namespace slammot::memory {

/// T is `Of`, const or not: the parameter of functions that list the parts of a value once for
/// saving and loading.
template <typename T, typename Of>
concept Like = std::same_as<std::remove_const_t<T>, Of>;

namespace detail {

template <typename T, template <typename...> class Of>
inline constexpr bool kIs = false;
template <template <typename...> class Of, typename... Arguments>
inline constexpr bool kIs<Of<Arguments...>, Of> = true;

template <typename T>
inline constexpr bool kIsArray = false;
template <typename T, std::size_t kSize>
inline constexpr bool kIsArray<std::array<T, kSize>> = true;

template <typename T>
concept Matrix = std::derived_from<T, Eigen::PlainObjectBase<T>>;
template <typename T>
concept FixedMatrix = Matrix<T> && T::SizeAtCompileTime != Eigen::Dynamic;
/// Elements of a vector that are copied as one block.
template <typename T>
concept Block = (std::is_arithmetic_v<T> && !std::same_as<T, bool>) || FixedMatrix<T>;

}  // namespace detail

/// Appends values to bytes.
class StateSaver {
 public:
  explicit StateSaver(std::vector<std::byte>& bytes) : bytes_(bytes) {}
  static constexpr bool kLoads = false;

  void block(const void* values, std::size_t size) { put_bytes(bytes_, values, size); }
  std::size_t count(std::size_t size) {
    put(bytes_, static_cast<std::uint64_t>(size));
    return size;
  }

 private:
  std::vector<std::byte>& bytes_;
};

/// Reads them back.
class StateLoader {
 public:
  explicit StateLoader(ByteReader& from) : from_(from) {}
  static constexpr bool kLoads = true;

  void block(void* values, std::size_t size) { from_.get_bytes(values, size); }
  /// Elements that follow, each of which takes at least a byte.
  std::size_t count(std::size_t) {
    std::uint64_t size = 0;
    from_.get(size);
    if (size > from_.left()) refuse();
    return ok() ? size : 0;
  }
  bool ok() const { return from_.ok(); }
  bool has(std::size_t size) const { return ok() && size <= from_.left(); }
  void refuse() { from_.refuse(); }

 private:
  ByteReader& from_;
};

/// Saves or loads nested values: numbers, enumerations, matrices, standard containers and queues of
/// them, and structs whose parts are listed, either by
///   static void visit_state(auto& self, auto& visit)   of the struct, with access to its members,
/// or by
///   static void visit(auto& visit, Like<Struct> auto& value)   of Parts.
/// Both call visit(part, ...). Parts::largest(Enum{}) is the largest value of an enumeration.
template <typename Parts, typename Stream>
class StateVisitor {
 public:
  explicit StateVisitor(Stream& stream) : stream_(stream) {}

  template <typename... Values>
  void operator()(Values&... values) {
    (visit(values), ...);
  }

 private:
  static constexpr double kLargestNumber = 1e9;

  template <typename Value>
  void visit(Value& value) {
    using T = std::remove_const_t<Value>;
    if constexpr (std::same_as<T, bool>) visit_bool(value);
    else if constexpr (std::is_arithmetic_v<T>) visit_block(&value, 1);
    else if constexpr (std::is_enum_v<T>) visit_enum(value);
    else if constexpr (detail::Matrix<T>) visit_matrix(value);
    else if constexpr (detail::kIs<T, std::optional>) visit_optional(value);
    else if constexpr (detail::kIs<T, std::variant>) visit_variant(value);
    else if constexpr (detail::kIs<T, std::vector> || std::same_as<T, std::string>)
      visit_vector(value);
    else if constexpr (detail::kIs<T, RecyclingQueue>) visit_queue(value);
    else if constexpr (detail::kIs<T, std::map>) visit_map(value);
    else if constexpr (detail::kIs<T, std::pair>) (*this)(value.first, value.second);
    else if constexpr (detail::kIsArray<T>) visit_each(value);
    else if constexpr (requires { T::visit_state(value, *this); }) T::visit_state(value, *this);
    else Parts::visit(*this, value);
  }

  void visit_each(auto& values) {
    for (auto& value : values) visit(value);
  }

  /// Any byte but 0 is true: a bool made of other bytes would be undefined.
  void visit_bool(auto& value) {
    std::uint8_t byte = value ? 1 : 0;
    stream_.block(&byte, 1);
    if constexpr (Stream::kLoads) value = byte != 0;
  }

  template <typename Enum>
  void visit_enum(Enum& value) {
    stream_.block(&value, sizeof value);
    if constexpr (Stream::kLoads) {
      if (value <= Parts::largest(Enum{})) return;
      value = Enum{};
      stream_.refuse();
    }
  }

  template <typename Matrix>
  void visit_matrix(Matrix& matrix) {
    if constexpr (!detail::FixedMatrix<std::remove_const_t<Matrix>>) {
      const std::size_t rows = stream_.count(static_cast<std::size_t>(matrix.rows()));
      const std::size_t columns = stream_.count(static_cast<std::size_t>(matrix.cols()));
      if constexpr (Stream::kLoads) {
        if (rows > 0 && !stream_.has(rows * columns)) return stream_.refuse();
        matrix.resize(static_cast<Eigen::Index>(rows), static_cast<Eigen::Index>(columns));
      }
    }
    visit_block(matrix.data(), static_cast<std::size_t>(matrix.size()));
  }

  /// Of numbers; larger ones than these are no state's, and overflow where they are rounded.
  template <typename Number>
  void visit_block(Number* numbers, std::size_t count) {
    stream_.block(numbers, count * sizeof(Number));
    if constexpr (Stream::kLoads && std::is_floating_point_v<Number>) {
      for (std::size_t i = 0; i < count; ++i) {
        if (!(std::abs(numbers[i]) < kLargestNumber)) return stream_.refuse();
      }
    }
  }

  void visit_optional(auto& value) {
    bool has_value = value.has_value();
    visit_bool(has_value);
    if constexpr (Stream::kLoads) {
      if (has_value) value.emplace();
      else value.reset();
    }
    if (value) visit(*value);
  }

  /// Of two alternatives.
  template <typename Variant>
  void visit_variant(Variant& value) {
    bool is_second = value.index() == 1;
    visit_bool(is_second);
    if constexpr (Stream::kLoads) {
      if (is_second) value.template emplace<1>();
      else value.template emplace<0>();
    }
    std::visit([this](auto& held) { this->visit(held); }, value);
  }

  template <typename Vector>
  void visit_vector(Vector& values) {
    using T = typename Vector::value_type;
    const std::size_t count = stream_.count(values.size());
    if constexpr (detail::Block<T>) {
      if constexpr (Stream::kLoads) values.resize(count);
      visit_numbers_of(values);
    } else {
      if constexpr (Stream::kLoads) load_each(values, count);
      else visit_each(values);
    }
  }

  template <typename Vector>
  void visit_numbers_of(Vector& values) {
    if constexpr (std::is_arithmetic_v<typename Vector::value_type>) {
      visit_block(values.data(), values.size());
    } else if (!values.empty()) {
      visit_block(values.front().data(),
                  values.size() * static_cast<std::size_t>(values.front().size()));
    }
  }

  /// Element by element, so that no damaged number of them fills the memory.
  void load_each(auto& values, std::size_t count) {
    values.clear();
    for (std::size_t i = 0; i < count && stream_.ok(); ++i) visit(values.emplace_back());
  }

  template <typename Queue>
  void visit_queue(Queue& values) {
    const std::size_t count = stream_.count(values.size());
    if constexpr (Stream::kLoads) {
      values.clear();
      for (std::size_t i = 0; i < count && stream_.ok(); ++i) visit(values.push_back());
    } else {
      for (std::size_t i = 0; i < count; ++i) visit(values[i]);
    }
  }

  template <typename Map>
  void visit_map(Map& values) {
    const std::size_t count = stream_.count(values.size());
    if constexpr (Stream::kLoads) {
      values.clear();
      for (std::size_t i = 0; i < count && stream_.ok(); ++i) {
        std::pair<typename Map::key_type, typename Map::mapped_type> entry;
        visit(entry);
        values.insert(std::move(entry));
      }
    } else {
      for (const auto& entry : values) (*this)(entry.first, entry.second);
    }
  }

  Stream& stream_;
};

}  // namespace slammot::memory
