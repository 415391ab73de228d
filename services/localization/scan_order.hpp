#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "common/sensing/scan.hpp"
#include "common/sensing/stamp_guard.hpp"

namespace slammot::localization {

/// Accepts scans in the order of their stamps; several scanners may share a stamp.
class ScanOrder {
 public:
  enum class Verdict {
    kUsable,
    kDuplicate,   ///< Same scanner and stamp as one before.
    kOutOfOrder,  ///< Older than one before.
    kFarAhead,    ///< Stamped far ahead of those before, and no second one agreed yet.
  };

  explicit ScanOrder(double far_ahead_s) : stamps_(far_ahead_s) {}

  /// last_stamp_ns: of the last scan that was accepted; none before the first one. A scan that is
  /// usable is accepted by accept().
  Verdict judge(const sensing::LaserScan& scan, const std::optional<std::int64_t>& last_stamp_ns);
  void accept(const sensing::LaserScan& scan, const std::optional<std::int64_t>& last_stamp_ns);

  /// Accepts a usable scan that is blank. Blank scans have an order of their own: false for a
  /// second one of the same scanner and stamp, or one older than a blank scan before.
  bool accept_blank(const sensing::LaserScan& scan);

 private:
  sensing::StampGuard stamps_;
  std::vector<std::string> scanners_at_last_;  ///< Whose scans have the last stamp; empty after a
                                               ///< restart.
  std::optional<std::int64_t> last_blank_ns_;
  std::vector<std::string> scanners_at_last_blank_;
};

}  // namespace slammot::localization
