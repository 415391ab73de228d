#include "services/tracking/scan_history.hpp"

#include <utility>

namespace slammot::tracking {
namespace {

constexpr std::int64_t kIntervalNs = 100'000'000;
constexpr std::int64_t kLongestNs = 2'000'000'000;

}  // namespace

void ScanHistory::add(std::int64_t stamp_ns, const PolarView& view, std::vector<Owner> owners) {
  if (!scans_.empty() && stamp_ns - scans_.back().stamp_ns < kIntervalNs) return;
  scans_.push_back({stamp_ns, view, std::move(owners)});
  while (stamp_ns - scans_.front().stamp_ns > kLongestNs) scans_.pop_front();
}

const EarlierScan* ScanHistory::older_than(std::int64_t stamp_ns, double age_s) const {
  const auto latest_ns = stamp_ns - static_cast<std::int64_t>(age_s * 1e9);
  for (auto scan = scans_.rbegin(); scan != scans_.rend(); ++scan)
    if (scan->stamp_ns <= latest_ns) return &*scan;
  return nullptr;
}

Past past_of(std::size_t beam, const PolarView& now, const EarlierScan& then) {
  const SightOfPlace before = then.view.sight_of(now.point_in_odom_m(beam));
  if (before.sight == Sight::kThrough) return Past::kArrived;
  if (before.sight == Sight::kNothing || then.owners[before.beam].is_confirmed) return Past::kUnknown;
  if (before.sight == Sight::kThere) return Past::kStood;
  const SightOfPlace where_it_was = now.sight_of(then.view.point_in_odom_m(before.beam));
  return where_it_was.sight == Sight::kThrough ? Past::kReceded : Past::kUnknown;
}

}  // namespace slammot::tracking
