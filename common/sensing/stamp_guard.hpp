#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>

namespace slammot::sensing {

/// Rejects single stamps far ahead, which would make all later ones look late. A stamp far ahead is
/// accepted only if a second, different one confirms it. A true gap costs one sample.
class StampGuard {
 public:
  explicit StampGuard(double far_ahead_s)
      : far_ahead_ns_(static_cast<std::int64_t>(far_ahead_s * 1e9)) {}

  bool believes(std::int64_t stamp_ns) {
    const bool is_near = !newest_ns_ || stamp_ns < *newest_ns_ || is_within(*newest_ns_, stamp_ns);
    const bool is_agreed_on =
        doubted_ns_ && stamp_ns != *doubted_ns_ &&
        is_within(std::min(*doubted_ns_, stamp_ns), std::max(*doubted_ns_, stamp_ns));
    if (!is_near && !is_agreed_on) {
      doubted_ns_ = stamp_ns;
      return false;
    }
    newest_ns_ = std::max(stamp_ns, newest_ns_.value_or(stamp_ns));
    doubted_ns_.reset();
    return true;
  }

 private:
  /// Unsigned: the difference of any two stamps fits into 64 bits.
  bool is_within(std::int64_t earlier_ns, std::int64_t later_ns) const {
    return static_cast<std::uint64_t>(later_ns) - static_cast<std::uint64_t>(earlier_ns) <=
           static_cast<std::uint64_t>(far_ahead_ns_);
  }

  std::int64_t far_ahead_ns_;
  std::optional<std::int64_t> newest_ns_;
  std::optional<std::int64_t> doubted_ns_;  ///< Last rejected stamp.
};

}  // namespace slammot::sensing
