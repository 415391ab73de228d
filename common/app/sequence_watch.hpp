#pragma once

#include <concepts>
#include <cstdint>
#include <map>
#include <string>

namespace slammot::app {

/// A sample of a scan: the scans of each scanner are numbered.
template <typename Sample>
concept IsNumberedScan = requires(const Sample& sample) {
  { sample.scanner_id[0] } -> std::convertible_to<char>;
  { sample.sequence_number } -> std::convertible_to<std::uint32_t>;
};

/// Counts the scans that never came, by the gaps in the numbers of each scanner.
class SequenceWatch {
 public:
  /// Number of scans missing between the last one of this scanner and this one. A number that is
  /// not higher begins anew: a source that restarted, or a repeated scan.
  std::uint32_t missed_before(const char* scanner, std::uint32_t number) {
    const auto known = last_.find(scanner);
    if (known == last_.end()) {
      if (last_.size() >= kMostScanners) last_.clear();
      last_.emplace(scanner, number);
      return 0;
    }
    const std::uint32_t last = known->second;
    known->second = number;
    return number > last ? number - last - 1 : 0;
  }

 private:
  static constexpr std::size_t kMostScanners = 100;
  std::map<std::string, std::uint32_t, std::less<>> last_;
};

}  // namespace slammot::app
