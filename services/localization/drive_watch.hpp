#pragma once

#include <algorithm>
#include <cstdint>
#include <deque>
#include <map>
#include <string>

namespace slammot::localization {

/// Which scans belong together: every source of scans names its drive. Several scanners of one
/// vehicle name their drives independently of each other, so a new one begins when a scanner that
/// is known names another.
class DriveWatch {
 public:
  enum class Scan {
    kOfThisDrive,
    kOfNewDrive,      ///< The other scanners are expected to follow.
    kOfEarlierDrive,  ///< From a scanner that has not heard of the new one yet.
  };

  Scan judge(const std::string& scanner_id, std::uint64_t drive_id) {
    const Scan scan = look_at(scanner_id, drive_id);
    if (scan == Scan::kOfEarlierDrive) return scan;
    if (scan == Scan::kOfNewDrive) retire();
    drive_by_scanner_[scanner_id] = drive_id;
    return scan;
  }

  /// What judge() would say; nothing begins.
  Scan look_at(const std::string& scanner_id, std::uint64_t drive_id) const {
    const auto known = drive_by_scanner_.find(scanner_id);
    if (known != drive_by_scanner_.end() && known->second == drive_id) return Scan::kOfThisDrive;
    if (std::ranges::find(earlier_, drive_id) != earlier_.end()) return Scan::kOfEarlierDrive;
    return known != drive_by_scanner_.end() ? Scan::kOfNewDrive : Scan::kOfThisDrive;
  }

  /// Lets a drive that ended begin again.
  void readmit(std::uint64_t drive_id) { std::erase(earlier_, drive_id); }

  /// The drive that each scanner is on.
  const std::map<std::string, std::uint64_t>& drives() const { return drive_by_scanner_; }

  /// Goes on with what another one knew.
  void take_up(const std::map<std::string, std::uint64_t>& drives) { drive_by_scanner_ = drives; }

 private:
  static constexpr std::size_t kRemembered = 16;

  void retire() {
    for (const auto& [scanner_id, drive_id] : drive_by_scanner_) earlier_.push_back(drive_id);
    while (earlier_.size() > kRemembered) earlier_.pop_front();
    drive_by_scanner_.clear();
  }

  std::map<std::string, std::uint64_t> drive_by_scanner_;
  std::deque<std::uint64_t> earlier_;
};

}  // namespace slammot::localization
