#include "services/localization/timing_scans.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace slammot::localization {
namespace {

using matching::MotionChange;

constexpr std::uint64_t kFewestScansBetween = 2;
constexpr std::uint64_t kMostScansBetween = 60;
constexpr double kFarthestPair_m = 6.0;  // so that both scans see the same
constexpr double kFarthestPair_rad = 0.5;
constexpr double kFarthestPoint_m = 30.0;  // beyond, echoes are rare on a surface
constexpr std::uint64_t kTimingEnds = 4;   // a rate is that of this part of the scans between
constexpr double kLeastTurn_radps = 0.07;  // changes that tell the delay to 0.05 s
constexpr double kLeastWay_mps = 0.4;

bool tells_timing(MotionChange change, double by) {
  return by > (matching::is_of_turn(change) ? kLeastTurn_radps : kLeastWay_mps);
}

}  // namespace

TimingScans::TimingScans() {
  constexpr std::size_t kUsualPoints = 512;
  for (Scan& scan : scans_) scan.points.reserve(kUsualPoints);
}

bool TimingScans::is_far(std::uint64_t first, std::uint64_t second) const {
  const geometry::Pose2& from = scan(first).wheel_from_base;
  const geometry::Pose2& to = scan(second).wheel_from_base;
  return (from.translation_m() - to.translation_m()).norm() > kFarthestPair_m ||
         std::abs(geometry::wrap_angle(from.heading_rad - to.heading_rad)) > kFarthestPair_rad;
}

TimingScans::Rates TimingScans::rates_between(std::uint64_t first, std::uint64_t second) const {
  const geometry::Pose2& from = scan(first).wheel_from_base;
  const geometry::Pose2& to = scan(second).wheel_from_base;
  const double time_s = 1e-9 * static_cast<double>(scan(second).stamp_ns - scan(first).stamp_ns);
  return {geometry::wrap_angle(to.heading_rad - from.heading_rad) / time_s,
          (to.translation_m() - from.translation_m()).norm() / time_s};
}

void TimingScans::add(std::int64_t stamp_ns, const geometry::Pose2& wheel_from_base,
                      const geometry::Pose2& odom_from_base,
                      const std::vector<matching::MatchPoint>& points) {
  const std::uint64_t second = next_++;
  Scan& added = scans_[second % kKept];
  added.stamp_ns = stamp_ns;
  added.wheel_from_base = wheel_from_base;
  added.odom_from_base = odom_from_base;
  added.points.clear();
  std::ranges::copy_if(points, std::back_inserter(added.points), [](const auto& point) {
    return point.in_base_m.squaredNorm() < kFarthestPoint_m * kFarthestPoint_m;
  });
  while (second - earliest_ > kMostScansBetween || is_far(earliest_, second)) ++earliest_;
  const std::uint64_t between = second - earliest_;
  if (between < kFewestScansBetween) return;
  const std::uint64_t end = std::max<std::uint64_t>(1, between / kTimingEnds);
  const Rates at_first = rates_between(earliest_, earliest_ + end);
  const Rates at_second = rates_between(second - end, second);
  const double turn_radps = std::abs(at_second.turn_radps) - std::abs(at_first.turn_radps);
  const double way_mps = at_second.way_mps - at_first.way_mps;
  offer({earliest_, second, turn_radps}, MotionChange::kTurnsMore);
  offer({earliest_, second, -turn_radps}, MotionChange::kTurnsLess);
  offer({earliest_, second, way_mps}, MotionChange::kFaster);
  offer({earliest_, second, -way_mps}, MotionChange::kSlower);
}

void TimingScans::offer(const Candidate& candidate, MotionChange change) {
  std::optional<Candidate>& latest = latest_[static_cast<std::size_t>(change)];
  if (latest && candidate.first >= latest->second) {
    complete_[static_cast<std::size_t>(change)] = latest;
    latest.reset();
  }
  if (tells_timing(change, candidate.change) && (!latest || candidate.change > latest->change))
    latest = candidate;
}

std::optional<TimingScans::Pair> TimingScans::take() {
  for (std::size_t i = 0; i < complete_.size(); ++i) {
    if (!complete_[i]) continue;
    const Candidate pair = *complete_[i];
    complete_[i].reset();
    if (next_ - pair.first > kKept) continue;
    return Pair{scan(pair.first), scan(pair.second), static_cast<MotionChange>(i)};
  }
  return std::nullopt;
}

void TimingScans::clear() {
  earliest_ = next_;
  latest_ = {};
  complete_ = {};
}

}  // namespace slammot::localization
