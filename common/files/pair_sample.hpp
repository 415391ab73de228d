#pragma once

#include <cstddef>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "common/files/carmen_record.hpp"
#include "common/files/log_plan.hpp"
#include "common/matching/scan_pair.hpp"
#include "common/matching/timing_pairs.hpp"
#include "common/sensing/companions.hpp"

namespace slammot::files {

/// Sample of scan pairs with little motion in between, spread over the log, limited in number.
class PairSample {
 public:
  /// A pair ends after this way or turn; it is dropped if the way exceeds the maximum.
  PairSample(double moved_m, double turned_rad, double most_m)
      : moved_m_(moved_m), turned_rad_(turned_rad), most_m_(most_m) {}

  /// scan: counted from 0.
  void add(const std::vector<float>& ranges, const geometry::Pose2& recorded, std::size_t scan);
  const std::vector<matching::ScanPair>& pairs() const { return pairs_; }

 private:
  static constexpr std::size_t kMost = 48;
  double moved_m_;
  double turned_rad_;
  double most_m_;
  std::vector<matching::ScanPair> pairs_;
  std::optional<std::pair<std::vector<float>, geometry::Pose2>> anchor_;
  std::size_t anchor_scan_ = 0;
  std::size_t scans_since_anchor_ = 0;
  std::size_t every_ = 1;
  std::size_t offered_ = 0;
};

/// Pairs of a scanner's scans by which the log is judged, without the echoes of what goes along
/// with the vehicle, which look as if it stood.
class ScanPairSurvey {
 public:
  /// recorded: pose by the odometry that the pairs are judged by. scan: counted from 0.
  void add(const LaserRecord& record, const geometry::Pose2& recorded, std::size_t scan);

  /// Pairs that tell the conventions of the log, whatever the unit of its ways is.
  std::vector<matching::ScanPair> pairs() const;
  /// Pairs that tell when odometry was read.
  std::vector<matching::ScanPair> timing_pairs() const { return timing_.pairs(); }

 private:
  std::vector<float> without_companions(const LaserRecord& record, const geometry::Pose2& recorded);

  sensing::Companions companions_;
  std::optional<geometry::Pose2> last_recorded_;
  PairSample moved_{0.25, 0.12, std::numeric_limits<double>::infinity()};
  PairSample in_small_units_{250.0, 0.12,
                             std::numeric_limits<double>::infinity()};  ///< In millimetres.
  PairSample turned_{1.2, 0.05, 1.2};  ///< Of a vehicle that seldom turns.
  matching::TimingPairs timing_;
};

/// Readings that are no echo by the plan, or of the main scanner's own vehicle, become NaN.
std::vector<matching::ScanPair> with_echoes_of_others(std::vector<matching::ScanPair> pairs,
                                                      const LogPlan& plan);

}  // namespace slammot::files
