#include "services/localization/factor_watch.hpp"

#include <algorithm>
#include <cmath>

namespace slammot::localization {
namespace {

using geometry::Pose2;

constexpr double kComparedWay_m = 1.0;  // by odometry, from which two scans are compared
constexpr double kComparedTurn_rad = 0.15;
constexpr double kSearched_m = 1.6;  // as of the pairs of a log: matching::match_all()
constexpr double kFarthestWay_m = 1.5 * kSearched_m;  // by odometry; a pair that is farther apart
constexpr double kMostComparedTurn_rad = 0.7;         // matches in a wrong place if at all
constexpr double kTurnReach = 2.3;  // turns may be so many times as large, of either sign
constexpr double kLeastTurnReach_rad = 0.3;
constexpr double kStraightCompared_rad = 0.12;  // else the way depends on the point of the vehicle
constexpr double kTurningCompared_rad = 0.06;   // a tenth of it is the noise of a match
constexpr float kFarthestOfFactors_m = 30.0F;
constexpr std::size_t kTargetPoints = 360;
constexpr std::size_t kSourcePoints = 90;
constexpr std::size_t kFewestOfPair = 20;
constexpr double kScoresAsWell = 0.95;  // of the score: odometry that fits as well is not refuted;
                                        // along a bare wall any way does
constexpr std::size_t kFewestRatios = 6;   // as of a log: matching::kFewestPairs
constexpr std::size_t kEnoughRatios = 16;  // to believe that nothing is wrong
constexpr double kOtherFactor = 0.15;  // less is learned by the filter, as after a log was examined
constexpr double kFactorSigmas = 6.0;
constexpr double kMedianFloor = 0.01;  // one sigma of a median
constexpr double kLeastFactor = 0.4;   // smaller ones are of scans that seem not to have moved
constexpr double kMostFactor = 2.5;

/// At most about so many, none that is far.
std::vector<Eigen::Vector2f> some_of(const std::vector<matching::MatchPoint>& points,
                                     std::size_t most) {
  std::vector<Eigen::Vector2f> some;
  const std::size_t stride = std::max<std::size_t>(1, points.size() / most);
  for (std::size_t i = 0; i < points.size(); i += stride) {
    const Eigen::Vector2f point_m = points[i].in_base_m.cast<float>();
    if (point_m.norm() < kFarthestOfFactors_m) some.push_back(point_m);
  }
  return some;
}

void set_target(const std::vector<Eigen::Vector2f>& points_m,
                matching::CorrelativeMatcher& matcher) {
  std::vector<matching::TargetPoint> stamped;
  float reach_m = 5.0F;
  for (const Eigen::Vector2f& point_m : points_m) {
    stamped.push_back({point_m.x(), point_m.y(), 1.0F});
    reach_m = std::max({reach_m, std::abs(point_m.x()), std::abs(point_m.y())});
  }
  const double half_m = static_cast<double>(reach_m) + 0.5;
  matcher.set_target(stamped, {.centre_m = geometry::Vector2::Zero(),
                               .half_width_m = half_m,
                               .half_height_m = half_m,
                               .largest_shift_m = kSearched_m});
}

}  // namespace

void FactorRatios::add(double by_scans_over_by_odometry) {
  if (count_ < kMost) ratios_[count_++] = by_scans_over_by_odometry;
}

FactorRatios::Spread FactorRatios::spread() const {
  constexpr double kSigmaOfDeviation = 1.4826;  // of a Gaussian
  constexpr double kSigmaOfMedian = 1.2533;     // over that of a mean
  std::array<double, kMost> sorted = ratios_;
  const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(count_ / 2);
  const auto end = sorted.begin() + static_cast<std::ptrdiff_t>(count_);
  std::nth_element(sorted.begin(), middle, end);
  const double median = *middle;
  std::transform(sorted.begin(), end, sorted.begin(),
                 [&](double ratio) { return std::abs(ratio - median); });
  std::nth_element(sorted.begin(), middle, end);
  const double sigma =
      kSigmaOfMedian * kSigmaOfDeviation * *middle / std::sqrt(static_cast<double>(count_));
  return {median, std::hypot(sigma, kMedianFloor)};
}

std::optional<double> FactorRatios::other_than(double in_use) const {
  if (is_settled_ || count_ < kFewestRatios) return std::nullopt;
  const auto [median, sigma] = spread();
  const double off = std::abs(median - in_use);
  const bool is_possible = std::abs(median) > kLeastFactor && std::abs(median) < kMostFactor;
  if (!is_possible || off < kOtherFactor * std::abs(in_use) || off < kFactorSigmas * sigma)
    return std::nullopt;
  return median;
}

void FactorRatios::settle(double in_use) {
  if (count_ == kMost || (count_ >= kEnoughRatios && !other_than(in_use))) is_settled_ = true;
}

FactorWatch::FactorWatch()
    : matcher_({.resolution_m = 0.1,
                .smear_sigma_m = 0.1,
                .heading_step_rad = 0.01,
                .min_score = 0.45,
                .max_peaks = 1,
                .min_peak_ratio = 0.7,
                .peak_separation_m = 0.5,
                .peak_separation_rad = 0.1}) {}

void FactorWatch::begin(const Seen& seen) {
  first_wheel_from_base_ = seen.wheel_from_base;
  first_ = some_of(seen.points, kTargetPoints);
  has_first_ = true;
}

/// Whether a pair says anything that is not known.
bool FactorWatch::tells(const Pose2& by_wheels) const {
  const double way_m = by_wheels.translation_m().norm();
  const double turn_rad = std::abs(by_wheels.heading_rad);
  if (way_m > kFarthestWay_m || turn_rad > kMostComparedTurn_rad) return false;
  const bool tells_way = way_m >= kComparedWay_m && !ways_.is_settled();
  const bool tells_turn = turn_rad >= kTurningCompared_rad && !turns_.is_settled();
  return tells_way || tells_turn;
}

bool FactorWatch::has_ended() const {
  constexpr std::size_t kMostPairs = 200;  // along bare walls none tells anything
  return pairs_ >= kMostPairs || (ways_.is_settled() && turns_.is_settled());
}

void FactorWatch::compare(const Pose2& by_wheels, const Points& second) {
  ++pairs_;
  if (first_.size() < kFewestOfPair || second.size() < kFewestOfPair) return;
  set_target(first_, matcher_);
  const double reach_rad =
      std::max(kLeastTurnReach_rad, kTurnReach * std::abs(by_wheels.heading_rad));
  const auto peaks =
      matcher_.search(second, Pose2::identity(), {kSearched_m, kSearched_m, reach_rad});
  if (peaks.empty()) return;
  const Pose2 by_scans = peaks.front().target_from_source;
  const bool refutes = matcher_.score(second, by_wheels) < kScoresAsWell * peaks.front().score;
  const auto count = [&](double scans, double wheels, FactorRatios& ratios) {
    const double ratio = scans / wheels;
    if (refutes || std::abs(ratio - 1.0) < kOtherFactor) ratios.add(ratio);
  };
  const double way_m = by_wheels.translation_m().norm();
  if (way_m >= kComparedWay_m && std::abs(by_scans.heading_rad) < kStraightCompared_rad)
    count(by_scans.translation_m().norm(), way_m, ways_);
  if (std::abs(by_wheels.heading_rad) >= kTurningCompared_rad)
    count(by_scans.heading_rad, by_wheels.heading_rad, turns_);
}

std::optional<sensing::WheelFactors> FactorWatch::observe(const Seen& seen,
                                                          const sensing::WheelFactors& in_use) {
  if (has_ended()) return std::nullopt;
  if (scanner_id_.empty()) scanner_id_ = seen.scanner_id;
  if (seen.scanner_id != scanner_id_) return std::nullopt;
  if (!has_first_) {
    begin(seen);
    return std::nullopt;
  }
  const Pose2 by_wheels = geometry::inverse(first_wheel_from_base_) * seen.wheel_from_base;
  if (by_wheels.translation_m().norm() < kComparedWay_m &&
      std::abs(by_wheels.heading_rad) < kComparedTurn_rad)
    return std::nullopt;
  if (tells(by_wheels)) compare(by_wheels, some_of(seen.points, kSourcePoints));
  begin(seen);
  ways_.settle(in_use.way);
  turns_.settle(in_use.turn);
  const auto way = ways_.other_than(in_use.way);
  const auto turn = turns_.other_than(in_use.turn);
  if (!way && !turn) return std::nullopt;
  return sensing::WheelFactors{.way = way.value_or(in_use.way),
                               .turn = turn.value_or(in_use.turn),
                               .turn_bias_radps = in_use.turn_bias_radps};
}

}  // namespace slammot::localization
