#pragma once

#include <array>
#include <cstddef>
#include <deque>
#include <optional>
#include <vector>

#include "common/geometry/pose2.hpp"
#include "common/matching/log_evidence.hpp"

namespace slammot::matching {

/// Selects the pairs of scans between which the turn rate or the speed of the vehicle changes most:
/// what odometry says of such a pair depends most on when it was read. Scans are added one by one;
/// memory is bounded.
class TimingPairs {
 public:
  /// ranges, recorded, scan: as in ScanPair.
  void add(const std::vector<float>& ranges, const geometry::Pose2& recorded, std::size_t scan);

  /// Those of the largest changes of each kind so far. Pairs of one kind do not overlap.
  std::vector<ScanPair> pairs() const;

 private:
  struct Scan {
    std::vector<float> ranges;
    geometry::Pose2 recorded;
    std::size_t number = 0;
  };
  struct Candidate {
    ScanPair pair;
    double change = 0.0;  ///< [rad] or [m] a scan.
  };
  /// The largest changes of one kind and sign.
  struct Kind {
    std::optional<Candidate> latest;  ///< The largest one of those that overlap.
    std::vector<Candidate> largest;
  };
  static void offer(const Scan& first, const Scan& second, double change, Kind& kind);
  static void keep(Candidate candidate, std::vector<Candidate>& largest);

  std::deque<Scan> recent_;
  std::array<Kind, 4> kinds_;  ///< Turn rate and speed, growing and falling.
};

}  // namespace slammot::matching
