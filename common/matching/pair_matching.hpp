#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "common/geometry/pose2.hpp"
#include "common/matching/log_correction.hpp"
#include "common/matching/scan_pair.hpp"

namespace slammot::matching {

/// A pair of scans with its motion by odometry and by scans.
struct MatchedPair {
  geometry::Pose2 by_odometry;  ///< Of base, with the corrections so far.
  geometry::Pose2 by_scans;     ///< Of the laser.
  double score = 0.0;
  std::size_t first_scan = 0;
  std::size_t second_scan = 0;
  std::size_t number = 0;  ///< Among the pairs.
};

/// Matches the scans of each pair by correlation, wherever odometry has the second one; those that
/// do not match are left out.
std::vector<MatchedPair> match_all(std::span<const ScanPair> pairs, const AssumedBeams& beams,
                                   const LogCorrection& correction);

/// Their motions by odometry, with corrections found since.
void take_odometry_anew(std::span<const ScanPair> pairs, const LogCorrection& correction,
                        std::vector<MatchedPair>& matched);

/// How many pairs match_all() tries: scans that are farther apart by odometry are not searched.
std::size_t pairs_within_reach(std::span<const ScanPair> pairs, const LogCorrection& correction);

}  // namespace slammot::matching
