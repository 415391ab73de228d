#pragma once

#include <cstdint>
#include <deque>
#include <memory>

#include "common/files/record_filter.hpp"

namespace slammot::files {

enum class LogClock : std::uint8_t;

/// Records of a log with the scans of each scanner in the order of their stamps, where these are
/// not far out of order in the log. Scans change places among each other; all other records stay
/// where they are.
class SortedRecords : public RecordFilter {
 public:
  /// A scan comes at most so many records of scans too late.
  static constexpr std::size_t kFarthest = 64;

  SortedRecords(std::unique_ptr<RecordSource> records, LogClock clock)
      : RecordFilter(std::move(records)), clock_(clock) {}

  std::optional<CarmenRecord> next() override;
  std::uint64_t line_number() const override { return line_number_; }

 private:
  struct Place {
    CarmenRecord record;
    std::uint64_t line_number = 0;
  };
  void sort_in();

  LogClock clock_;
  std::deque<Place> waiting_;
  std::size_t waiting_scans_ = 0;
  std::uint64_t line_number_ = 0;
};

}  // namespace slammot::files
