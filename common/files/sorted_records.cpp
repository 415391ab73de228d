#include "common/files/sorted_records.hpp"

#include <utility>
#include <variant>

#include "common/files/log_plan.hpp"

namespace slammot::files {
namespace {

std::optional<std::int64_t> stamp_of(const LaserRecord& record, LogClock clock) {
  return clock == LogClock::kLogger ? record.stamps.logger_ns : record.stamps.ipc_ns;
}

bool are_of_one_scanner(const LaserRecord& one, const LaserRecord& other) {
  return one.kind == other.kind && one.slot == other.slot;
}

}  // namespace

std::optional<CarmenRecord> SortedRecords::next() {
  while (waiting_scans_ <= kFarthest) {
    auto record = records().next();
    if (!record) break;
    if (std::holds_alternative<ParamRecord>(*record)) {  // refers to its line
      line_number_ = records().line_number();
      return record;
    }
    const bool is_scan = std::holds_alternative<LaserRecord>(*record);
    waiting_.push_back({std::move(*record), records().line_number()});
    if (is_scan) sort_in();
  }
  if (waiting_.empty()) return std::nullopt;
  Place first = std::move(waiting_.front());
  waiting_.pop_front();
  if (std::holds_alternative<LaserRecord>(first.record)) --waiting_scans_;
  line_number_ = first.line_number;
  return std::move(first.record);
}

/// Moves the last scan before those of its scanner that are newer.
void SortedRecords::sort_in() {
  ++waiting_scans_;
  auto* last = std::get_if<LaserRecord>(&waiting_.back().record);
  for (std::size_t i = waiting_.size() - 1; i-- > 0;) {
    auto* const before = std::get_if<LaserRecord>(&waiting_[i].record);
    if (before == nullptr || !are_of_one_scanner(*before, *last)) continue;
    const auto stamp_before = stamp_of(*before, clock_);
    const auto stamp = stamp_of(*last, clock_);
    if (!stamp || !stamp_before || *stamp_before <= *stamp) return;
    std::swap(*before, *last);
    last = before;
  }
}

}  // namespace slammot::files
