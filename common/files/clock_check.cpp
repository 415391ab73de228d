#include "common/files/clock_check.hpp"

#include "common/geometry/order_statistics.hpp"

namespace slammot::files {

/// Discards a first stamp in the future, after which all others would be late.
void ClockCheck::restart_without_first() {
  constexpr double kFarAhead_s = 60.0;
  sensing::StampGuard of_the_others{kFarAhead_s};
  const std::int64_t second_ns = first_ns_[1];
  const std::int64_t third_ns = first_ns_[2];
  begins_ahead_ = second_ns < third_ns && of_the_others.believes(second_ns) &&
                  of_the_others.believes(third_ns) && !of_the_others.believes(first_ns_[0]);
  if (!begins_ahead_) return;
  guard_ = sensing::StampGuard{600.0};
  newest_ns_.reset();
  steps_ns_.clear();
  counts_scans_ = true;
  scans_ = 0;
  advancing_ = 0;
  add(second_ns);
  add(third_ns);
}

void ClockCheck::add(std::optional<std::int64_t> stamp_ns) {
  if (stamp_ns && first_ns_.size() < 3) {
    first_ns_.push_back(*stamp_ns);
    if (first_ns_.size() == 3) restart_without_first();
    if (begins_ahead_) return;
  }
  ++scans_;
  if (!stamp_ns || !guard_.believes(*stamp_ns)) return;
  if (newest_ns_ && *stamp_ns > *newest_ns_) {
    ++advancing_;
    steps_ns_.push_back(*stamp_ns - *newest_ns_);
    counts_scans_ =
        counts_scans_ && steps_ns_.back() == 1'000'000'000 && *stamp_ns % 1'000'000'000 == 0;
  }
  if (!newest_ns_ || *stamp_ns > *newest_ns_) newest_ns_ = stamp_ns;
}

bool ClockCheck::is_usable() const {
  constexpr double kAdvancingShare = 0.9;  // localization handles duplicates and a few late scans
  constexpr double kMinPeriodS = 1e-4;
  constexpr double kMaxPeriodS = 60.0;
  if (scans_ == 0) return false;
  if (scans_ == 1) return newest_ns_.has_value();
  if (counts_scans_ && scans_ > 2) return false;
  if (static_cast<double>(advancing_) < kAdvancingShare * static_cast<double>(scans_ - 1))
    return false;
  const double median_s =
      geometry::lower_quantile({steps_ns_.begin(), steps_ns_.end()}, 0.5) * 1e-9;
  return median_s >= kMinPeriodS && median_s <= kMaxPeriodS;
}

}  // namespace slammot::files
