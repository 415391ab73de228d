#include "services/tracking/scan_history.hpp"

#include <algorithm>

namespace slammot::tracking {
namespace {

constexpr std::int64_t kIntervalNs = 100'000'000;
constexpr double kNearM = 0.5;  ///< Less than a step of a pedestrian.
constexpr double kGoesAlongM = 0.35;
constexpr std::int64_t kGoesAlongForNs = 250'000'000;
constexpr std::int64_t kGoesAlongSinceNs = 700'000'000;
constexpr std::int64_t kLongestNs = 2'000'000'000;

/// True if the scan had an echo within this distance, not of an object known to move.
bool had_something_near(const EarlierScan& scan, const Eigen::Vector2d& point_in_odom_m,
                        double within_m) {
  return scan.view.any_echo_near(point_in_odom_m, within_m,
                                 [&](std::size_t beam) { return !scan.owners[beam].is_confirmed; });
}

}  // namespace

bool ScanHistory::is_due(std::int64_t stamp_ns) const {
  return scans_.empty() || stamp_ns - scans_.back().stamp_ns >= kIntervalNs;
}

void ScanHistory::add(std::int64_t stamp_ns, const PolarView& view, std::span<const Owner> owners) {
  if (!is_due(stamp_ns)) return;
  while (!scans_.empty() && stamp_ns - scans_.front().stamp_ns > kLongestNs) scans_.pop_front();
  EarlierScan& scan = scans_.push_back();
  scan.stamp_ns = stamp_ns;
  scan.view = view;
  scan.view.measure_depths();
  scan.owners.assign(owners.begin(), owners.end());
}

bool ScanHistory::is_sound() const {
  for (const EarlierScan& scan : scans_.all()) {
    if (!scan.view.is_sound() || scan.owners.size() != scan.view.beam_count()) return false;
  }
  return true;
}

void ScanHistory::measure_depths() {
  for (EarlierScan& scan : scans_.all()) scan.view.measure_depths();
}

void ScanHistory::confirm(flow::TrackId track_id) {
  for (EarlierScan& scan : scans_.all())
    for (Owner& owner : scan.owners)
      owner.is_confirmed = owner.is_confirmed || (owner.is_owned && owner.track_id == track_id);
}

const EarlierScan* ScanHistory::older_than(std::int64_t stamp_ns, double age_s) const {
  const auto latest_ns = stamp_ns - static_cast<std::int64_t>(age_s * 1e9);
  for (std::size_t i = scans_.size(); i-- > 0;)
    if (scans_[i].stamp_ns <= latest_ns) return &scans_[i];
  return nullptr;
}

Past ScanHistory::past_of(std::size_t beam, const PolarView& now, const EarlierScan& then,
                          bool may_appear) const {
  return past_of(beam, then.view.sight_of(now.point_in_odom_m(beam)), now, then, may_appear);
}

Past ScanHistory::past_of(std::size_t beam, const SightOfPlace& before, const PolarView& now,
                          const EarlierScan& then, bool may_appear) const {
  const Eigen::Vector2d& point_m = now.point_in_odom_m(beam);
  switch (before.sight) {
    case Sight::kThrough: return Past::kArrived;
    case Sight::kNothing: return Past::kUnknown;
    case Sight::kThere:
      return then.owners[before.beam].is_confirmed ? Past::kUnknown : Past::kStood;
    case Sight::kHidden: break;
    case Sight::kEmpty: {
      if (!may_appear) return Past::kUnknown;
      const Eigen::Vector2d from_laser_m = point_m - now.laser_in_odom_m();
      const std::int64_t a_while_ago_ns = scans_.back().stamp_ns - kGoesAlongForNs;
      const std::int64_t since_ns =
          std::min(then.stamp_ns, scans_.back().stamp_ns - kGoesAlongSinceNs);
      const bool was_near = std::ranges::any_of(scans_.all(), [&](const EarlierScan& scan) {
        return (scan.stamp_ns <= then.stamp_ns && had_something_near(scan, point_m, kNearM)) ||
               (scan.stamp_ns >= since_ns && scan.stamp_ns <= a_while_ago_ns &&
                had_something_near(scan, scan.view.laser_in_odom_m() + from_laser_m, kGoesAlongM));
      });
      return was_near ? Past::kUnknown : Past::kAppeared;
    }
  }
  if (then.owners[before.beam].is_confirmed) return Past::kUnknown;
  const SightOfPlace where_it_was = now.sight_of(then.view.point_in_odom_m(before.beam));
  return where_it_was.sight == Sight::kThrough ? Past::kReceded : Past::kUnknown;
}

}  // namespace slammot::tracking
