#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "common/matching/log_correction.hpp"
#include "common/matching/odometry_check.hpp"
#include "common/matching/odometry_lateness.hpp"
#include "common/matching/scan_pair.hpp"

namespace slammot::matching {

/// Result of matching pairs of scans of a log.
struct LogEvidence {
  LogCorrection correction;
  bool handedness_is_told = true;  ///< False if scans and odometry turn differently and nothing
                                   ///< tells which is mirrored.
  std::size_t pairs = 0;           ///< Number of well matched pairs.
  std::size_t turning_pairs = 0;   ///< Of these, pairs with a turn by odometry.
  double matched_share = 0.0;      ///< Share of the tried pairs.
  double turn_sign_share = 0.0;  ///< Share of turning pairs whose turn by scans has the sign of the
                                 ///< recorded odometry's.
  double turn_scale = 0.0;       ///< Median of turn by scans over corrected turn by odometry; 0:
                                 ///< unknown.
  double way_scale = 0.0;  ///< Median of way by scans over corrected way by odometry; 0: unknown.
  std::vector<ScanPairMotion> motions;  ///< Of the matched pairs, in metres.
};

/// Matches the pairs by correlation under the stated layout, and infers units, signs, field of view
/// and mounting where many pairs agree. range_unit_m: estimated from the readings alone. If it is
/// not metres, odometry decides between millimetres and centimetres.
LogEvidence weigh_log(std::span<const ScanPair> pairs, const AssumedBeams& beams,
                      const OdometryCheck& odometry, double range_unit_m);

/// Metres per unit of readings with this median and 90th percentile. Assumes that no scanner sees
/// 100 m at half of its beams, and that none has a range limit of 2.5 m.
double range_unit_of(double median_reading, double far_reading);

}  // namespace slammot::matching
