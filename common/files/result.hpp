#pragma once

#include <cassert>
#include <string>
#include <utility>
#include <variant>

namespace slammot::files {

/// Reason of a failure, in one line for the terminal.
struct Error {
  std::string message;
};

/// A value, or the error.
template <typename T>
class [[nodiscard]] Result {
 public:
  Result(T value)
      : content_(std::move(value)) {}  // NOLINT(google-explicit-constructor): `return value;` is
                                       // the point
  Result(Error error) : content_(std::move(error)) {}  // NOLINT(google-explicit-constructor)

  bool has_value() const { return std::holds_alternative<T>(content_); }
  explicit operator bool() const { return has_value(); }

  T& operator*() { return value(); }
  const T& operator*() const { return value(); }
  T* operator->() { return &value(); }
  const T* operator->() const { return &value(); }

  const Error& error() const {
    assert(!has_value());
    return std::get<Error>(content_);
  }

 private:
  T& value() {
    assert(has_value());
    return std::get<T>(content_);
  }
  const T& value() const {
    assert(has_value());
    return std::get<T>(content_);
  }

  std::variant<T, Error> content_;
};

}  // namespace slammot::files
