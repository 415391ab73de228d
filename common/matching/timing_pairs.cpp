#include "common/matching/timing_pairs.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace slammot::matching {
namespace {

constexpr std::size_t kMostOfAKind = 16;
constexpr std::size_t kFewestScansBetween = 2;
constexpr std::size_t kMostScansBetween = 40;
constexpr double kFarthestPair_m = 2.5;  // so that both scans see the same
constexpr double kFarthestPair_rad = 0.3;
constexpr std::size_t kEnds = 4;  // a rate is that of this part of the scans between

struct Rates {
  double turn_rad = 0.0;  // a scan
  double way_m = 0.0;
};

Rates rates_between(const geometry::Pose2& first, const geometry::Pose2& second,
                    std::size_t scans) {
  const auto count = static_cast<double>(scans);
  return {geometry::wrap_angle(second.heading_rad - first.heading_rad) / count,
          (second.translation_m() - first.translation_m()).norm() / count};
}

}  // namespace

void TimingPairs::add(const std::vector<float>& ranges, const geometry::Pose2& recorded,
                      std::size_t scan) {
  recent_.push_back({ranges, recorded, scan});
  const auto is_far = [&](const Scan& one) {
    return (one.recorded.translation_m() - recorded.translation_m()).norm() > kFarthestPair_m ||
           std::abs(geometry::wrap_angle(one.recorded.heading_rad - recorded.heading_rad)) >
               kFarthestPair_rad;
  };
  while (recent_.size() > kMostScansBetween + 1 || (recent_.size() > 1 && is_far(recent_.front())))
    recent_.pop_front();
  if (recent_.size() <= kFewestScansBetween) return;
  const Scan& first = recent_.front();
  const Scan& second = recent_.back();
  if (first.ranges.size() != second.ranges.size()) return;
  const std::size_t end = std::max<std::size_t>(1, (recent_.size() - 1) / kEnds);
  const Rates at_first = rates_between(first.recorded, recent_[end].recorded, end);
  const Rates at_second =
      rates_between(recent_[recent_.size() - 1 - end].recorded, second.recorded, end);
  const double turn_rad = std::abs(at_second.turn_rad) - std::abs(at_first.turn_rad);
  const double way_m = at_second.way_m - at_first.way_m;
  offer(first, second, std::abs(turn_rad), kinds_[turn_rad > 0.0 ? 0 : 1]);
  offer(first, second, std::abs(way_m), kinds_[way_m > 0.0 ? 2 : 3]);
}

void TimingPairs::offer(const Scan& first, const Scan& second, double change, Kind& kind) {
  const bool overlaps = kind.latest && first.number < kind.latest->pair.second_scan;
  if (overlaps && change <= kind.latest->change) return;
  if (kind.latest && !overlaps) keep(*std::move(kind.latest), kind.largest);
  kind.latest = Candidate{
      {first.ranges, second.ranges, first.recorded, second.recorded, first.number, second.number},
      change};
}

void TimingPairs::keep(Candidate candidate, std::vector<Candidate>& largest) {
  if (largest.size() < kMostOfAKind) return largest.push_back(std::move(candidate));
  const auto least = std::ranges::min_element(largest, {}, &Candidate::change);
  if (least->change < candidate.change) *least = std::move(candidate);
}

std::vector<ScanPair> TimingPairs::pairs() const {
  std::vector<ScanPair> all;
  for (const Kind& kind : kinds_) {
    std::vector<Candidate> largest = kind.largest;
    if (kind.latest) keep(*kind.latest, largest);
    for (Candidate& candidate : largest) all.push_back(std::move(candidate.pair));
  }
  return all;
}

}  // namespace slammot::matching
