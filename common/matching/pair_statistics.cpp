#include "common/matching/pair_statistics.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "common/geometry/order_statistics.hpp"

namespace slammot::matching {
namespace {

constexpr double kTurningRad = 0.045;
constexpr double kMostTurnRad = 1.3;
constexpr double kStraightRad = 0.12;
constexpr double kMovingM = 0.15;

}  // namespace

std::vector<MatchedPair> turning(const std::vector<MatchedPair>& matched) {
  std::vector<MatchedPair> some;
  std::copy_if(matched.begin(), matched.end(), std::back_inserter(some),
               [](const MatchedPair& pair) {
                 return std::abs(pair.by_odometry.heading_rad) > kTurningRad &&
                        std::abs(pair.by_odometry.heading_rad) < kMostTurnRad;
               });
  return some;
}

double same_sign_share(const std::vector<MatchedPair>& turning_pairs) {
  if (turning_pairs.empty()) return 0.0;
  const auto same =
      std::count_if(turning_pairs.begin(), turning_pairs.end(), [](const MatchedPair& pair) {
        return pair.by_odometry.heading_rad * pair.by_scans.heading_rad > 0.0;
      });
  return static_cast<double>(same) / static_cast<double>(turning_pairs.size());
}

double turn_scale(const std::vector<MatchedPair>& turning_pairs) {
  std::vector<double> scales;
  scales.reserve(turning_pairs.size());
  for (const MatchedPair& pair : turning_pairs)
    scales.push_back(pair.by_scans.heading_rad / pair.by_odometry.heading_rad);
  return scales.size() < kFewestPairs ? 0.0 : geometry::upper_median(std::move(scales));
}

double turn_scale_of_both(const std::vector<MatchedPair>& matched) {
  std::vector<MatchedPair> by_scans = matched;
  for (MatchedPair& pair : by_scans) std::swap(pair.by_odometry, pair.by_scans);
  const double of_odometry = turn_scale(turning(matched));
  const double of_scans = turn_scale(turning(by_scans));
  if (of_odometry <= 0.0 || of_scans == 0.0) return of_odometry;
  if (of_scans < 0.0) return 0.0;
  const double inverse = 1.0 / of_scans;
  if ((of_odometry > 1.0) != (inverse > 1.0)) return 1.0;
  return of_odometry > 1.0 ? std::min(of_odometry, inverse) : std::max(of_odometry, inverse);
}

std::vector<MatchedPair> straight(const std::vector<MatchedPair>& matched) {
  std::vector<MatchedPair> some;
  std::copy_if(matched.begin(), matched.end(), std::back_inserter(some),
               [](const MatchedPair& pair) {
                 return std::abs(pair.by_scans.heading_rad) < kStraightRad &&
                        pair.by_scans.translation_m().norm() > kMovingM &&
                        pair.by_odometry.translation_m().norm() > 0.0;
               });
  return some;
}

double way_scale(const std::vector<MatchedPair>& straight_pairs) {
  std::vector<double> scales;
  scales.reserve(straight_pairs.size());
  for (const MatchedPair& pair : straight_pairs)
    scales.push_back(pair.by_scans.translation_m().norm() /
                     pair.by_odometry.translation_m().norm());
  return scales.size() < kFewestPairs ? 0.0 : geometry::upper_median(std::move(scales));
}

std::complex<double> mounting(const std::vector<MatchedPair>& straight_pairs) {
  std::complex<double> sum;
  for (const MatchedPair& pair : straight_pairs) {
    const std::complex<double> odometry(pair.by_odometry.x_m, pair.by_odometry.y_m);
    const std::complex<double> scans(pair.by_scans.x_m, pair.by_scans.y_m);
    sum += odometry / std::abs(odometry) * std::conj(scans / std::abs(scans));
  }
  return straight_pairs.empty() ? 0.0 : sum / static_cast<double>(straight_pairs.size());
}

}  // namespace slammot::matching
