#pragma once

#include <cstdint>
#include <stdexcept>
#include <string>
#include <utility>

namespace slammot::dds {

/// An unexpected failure of a call on a working bus.
class Error : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Owns one entity of the C library.
class Entity {
 public:
  using Handle = std::int32_t;

  Entity() = default;
  /// Takes the result of a creating call. Throws Error("WHAT: REASON") if that call failed.
  Entity(Handle handle_or_error, const std::string& what);
  ~Entity();
  Entity(Entity&& other) noexcept : handle_(std::exchange(other.handle_, 0)) {}
  Entity& operator=(Entity&& other) noexcept {
    std::swap(handle_, other.handle_);
    return *this;
  }

  Handle handle() const { return handle_; }

 private:
  Handle handle_ = 0;
};

/// Throws Error("WHAT: REASON") if `code` is one of the C library's negative return codes; returns
/// it otherwise.
std::int32_t check(std::int32_t code, const std::string& what);

}  // namespace slammot::dds
