#pragma once

#include <optional>
#include <string_view>
#include <utility>

namespace slammot::wire {

/// Why a sample from the bus is refused; a literal.
struct Fault {
  std::string_view reason;
};

/// A decoded value, or the reason of its rejection. Decoders check everything: consistent sizes,
/// enumerators, finite numbers, valid variances. Algorithms need no such checks.
template <typename Value>
class Decoded {
 public:
  Decoded(Value value) : value_(std::move(value)) {}
  Decoded(Fault fault) : fault_(fault.reason) {}

  explicit operator bool() const { return value_.has_value(); }
  const Value& operator*() const { return *value_; }
  Value& operator*() { return *value_; }
  const Value* operator->() const { return &*value_; }
  /// Empty when there is a value.
  std::string_view fault() const { return fault_; }

 private:
  std::optional<Value> value_;
  std::string_view fault_;
};

}  // namespace slammot::wire
