#pragma once

#include <complex>
#include <cstddef>
#include <vector>

#include "common/matching/pair_matching.hpp"

namespace slammot::matching {

inline constexpr std::size_t kFewestPairs = 8;  ///< From which anything is concluded.

/// Pairs with a turn by odometry.
std::vector<MatchedPair> turning(const std::vector<MatchedPair>& matched);

/// Pairs with straight motion by scans: the laser's position on the vehicle does not affect them.
std::vector<MatchedPair> straight(const std::vector<MatchedPair>& matched);

/// Share of the pairs that turn to the same side by odometry and by scans; 0 for none.
double same_sign_share(const std::vector<MatchedPair>& turning_pairs);

/// Median of turn by scans over turn by odometry; 0 for fewer than kFewestPairs.
double turn_scale(const std::vector<MatchedPair>& turning_pairs);

/// Whichever scale is nearer to 1: of the pairs that turn by odometry or of those that turn by
/// scans. Odometry whose noise is as large as the turns has turns too large in the former, and one
/// scan matched wrongly in the latter.
double turn_scale_of_both(const std::vector<MatchedPair>& matched);

/// Median of way by scans over way by odometry; 0 for fewer than kFewestPairs.
double way_scale(const std::vector<MatchedPair>& straight_pairs);

/// Mean of exp(i (direction by odometry - direction by scans)) over straight pairs.
std::complex<double> mounting(const std::vector<MatchedPair>& straight_pairs);

}  // namespace slammot::matching
