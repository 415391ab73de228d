#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "common/sensing/stamp_guard.hpp"

namespace slammot::files {

/// Tests whether the stamps of scans advance like a clock.
class ClockCheck {
 public:
  void add(std::optional<std::int64_t> stamp_ns);

  bool is_usable() const;

  /// True if the first stamp is far ahead of the second and the third one, which are consistent.
  /// The first one is left out.
  bool begins_ahead() const { return begins_ahead_; }

 private:
  void restart_without_first();

  std::vector<std::int64_t> first_ns_;  ///< Three of them.
  bool begins_ahead_ = false;
  std::uint64_t scans_ = 0;
  std::uint64_t advancing_ = 0;       ///< Newer than all before.
  bool counts_scans_ = true;          ///< Whole numbers one second apart.
  sensing::StampGuard guard_{600.0};  ///< Localization handles single wrong stamps.
  std::optional<std::int64_t> newest_ns_;
  std::vector<std::int64_t> steps_ns_;
};

}  // namespace slammot::files
