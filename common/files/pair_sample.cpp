#include "common/files/pair_sample.hpp"

#include <numbers>

#include "common/files/pose_difference.hpp"
#include "common/geometry/order_statistics.hpp"

namespace slammot::files {
namespace {

/// True if successive scans are mostly more units apart than a vehicle drives metres between them.
bool are_in_small_units(const std::vector<matching::ScanPair>& pairs) {
  constexpr double kFarthest_m = 20.0;
  std::vector<double> ways;
  for (const matching::ScanPair& pair : pairs)
    ways.push_back(distance_m(pair.first_recorded, pair.second_recorded));
  return geometry::lower_quantile(std::move(ways), 0.5) > kFarthest_m;
}

}  // namespace

/// A pair begins at the end of the one before; if there are too many pairs, every other one is
/// dropped.
void PairSample::add(const std::vector<float>& ranges, const geometry::Pose2& recorded,
                     std::size_t scan) {
  constexpr std::size_t kMostScansBetween = 40;
  const bool has_moved = anchor_ && differ(anchor_->second, recorded, moved_m_, turned_rad_);
  if (anchor_ && !has_moved && ++scans_since_anchor_ < kMostScansBetween) return;
  const bool is_wanted = has_moved && anchor_->first.size() == ranges.size() &&
                         distance_m(anchor_->second, recorded) <= most_m_;
  if (is_wanted && offered_++ % every_ == 0)
    pairs_.push_back(
        {std::move(anchor_->first), ranges, anchor_->second, recorded, anchor_scan_, scan});
  anchor_.emplace(ranges, recorded);
  anchor_scan_ = scan;
  scans_since_anchor_ = 0;
  if (pairs_.size() <= kMost) return;
  every_ *= 2;
  std::vector<matching::ScanPair> kept;
  for (std::size_t i = 0; i < pairs_.size(); i += 2) kept.push_back(std::move(pairs_[i]));
  pairs_ = std::move(kept);
}

std::vector<float> ScanPairSurvey::without_companions(const LaserRecord& record,
                                                      const geometry::Pose2& recorded) {
  std::vector<float> readings = record.range_m;
  const BeamLayout layout =
      record.layout.value_or(layout_by_convention(readings.size(), std::numbers::pi));
  const geometry::Pose2 moved =
      last_recorded_ ? geometry::inverse(*last_recorded_) * recorded : geometry::Pose2{};
  last_recorded_ = recorded;
  for (const std::size_t beam :
       companions_.observe({record.range_m, layout.first_beam_rad, layout.beam_step_rad,
                            std::numeric_limits<double>::infinity()},
                           moved))
    readings[beam] = std::numeric_limits<float>::quiet_NaN();
  return readings;
}

void ScanPairSurvey::add(const LaserRecord& record, const geometry::Pose2& recorded,
                         std::size_t scan) {
  const std::vector<float> readings = without_companions(record, recorded);
  moved_.add(readings, recorded, scan);
  in_small_units_.add(readings, recorded, scan);
  turned_.add(readings, recorded, scan);
  timing_.add(readings, recorded, scan);
}

std::vector<matching::ScanPair> ScanPairSurvey::pairs() const {
  std::vector<matching::ScanPair> pairs =
      are_in_small_units(moved_.pairs()) ? in_small_units_.pairs() : moved_.pairs();
  pairs.insert(pairs.end(), turned_.pairs().begin(), turned_.pairs().end());
  return pairs;
}

std::vector<matching::ScanPair> with_echoes_of_others(std::vector<matching::ScanPair> pairs,
                                                      const LogPlan& plan) {
  constexpr float kNone = std::numeric_limits<float>::quiet_NaN();
  if (pairs.empty()) return pairs;
  const ScannerPlan& scanner = plan.scanners.front();
  const auto no_echo = static_cast<float>(plan.max_range_m / plan.evidence.correction.range_unit_m);
  const auto leave_out = [&](std::vector<float>& ranges) {
    scanner.own_body.hide(ranges, kNone);
    scanner.floor.hide(ranges, kNone);
    for (float& range : ranges) range = range > 0.0F && range < no_echo ? range : kNone;
  };
  for (matching::ScanPair& pair : pairs) {
    leave_out(pair.first);
    leave_out(pair.second);
  }
  return pairs;
}

}  // namespace slammot::files
