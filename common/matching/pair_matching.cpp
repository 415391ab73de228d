#include "common/matching/pair_matching.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "common/matching/correlative.hpp"
#include "common/matching/pair_registration.hpp"

namespace slammot::matching {
namespace {

using geometry::Pose2;

constexpr double kReachM = 1.6;

Pose2 motion_by_odometry(const ScanPair& pair, const LogCorrection& correction) {
  return inverse(corrected(correction, pair.first_recorded)) *
         corrected(correction, pair.second_recorded);
}

/// Sub-cell position of the peak: vertex of the parabola through the scores around it, along each
/// axis.
Pose2 refined(const CorrelativeMatcher& matcher, std::span<const Eigen::Vector2f> source,
              const Pose2& peak) {
  constexpr double kStepM = 0.1;
  constexpr double kStepRad = 0.01;
  const double middle = matcher.score(source, peak);
  const auto top = [&](const Pose2& before, const Pose2& after) {
    const double lower = matcher.score(source, before);
    const double upper = matcher.score(source, after);
    const double bend = lower - 2.0 * middle + upper;
    return bend < 0.0 ? std::clamp(0.5 * (lower - upper) / bend, -0.5, 0.5) : 0.0;
  };
  const auto& [x_m, y_m, heading_rad] = peak;
  return {x_m + kStepM * top({x_m - kStepM, y_m, heading_rad}, {x_m + kStepM, y_m, heading_rad}),
          y_m + kStepM * top({x_m, y_m - kStepM, heading_rad}, {x_m, y_m + kStepM, heading_rad}),
          heading_rad + kStepRad * top({x_m, y_m, heading_rad - kStepRad},
                                       {x_m, y_m, heading_rad + kStepRad})};
}

/// False for a pair that odometry has farther apart than the search reaches, by a factor that is no
/// unit: where such a pair matches, it matches in a wrong place, and tells of no scale or sign.
bool is_within_reach(const Pose2& by_odometry) {
  constexpr double kMostFactor = 1.5;
  constexpr double kAnotherUnit_m = 20.0;
  const double way_m = by_odometry.translation_m().norm();
  return way_m < kMostFactor * kReachM || way_m > kAnotherUnit_m;
}

struct PairPeak {
  Pose2 target_from_source;
  double score = 0.0;
};

/// Search window for any turn up to 1.5 rad of either sign, and for the way in any direction.
std::optional<PairPeak> best_match(CorrelativeMatcher& matcher, const std::vector<float>& target,
                                   const std::vector<float>& source, const AssumedBeams& beams,
                                   const LogCorrection& correction, double turn_rad) {
  constexpr std::size_t kTargetPoints = 360;
  constexpr std::size_t kSourcePoints = 90;
  constexpr std::size_t kFewestPoints = 20;
  const auto target_m = points_of(target, beams, correction.range_unit_m, kTargetPoints);
  const auto source_m = points_of(source, beams, correction.range_unit_m, kSourcePoints);
  if (target_m.size() < kFewestPoints || source_m.size() < kFewestPoints) return std::nullopt;
  std::vector<TargetPoint> stamped;
  float reach_m = 5.0F;
  for (const Eigen::Vector2f& point : target_m) {
    stamped.push_back({point.x(), point.y(), 1.0F});
    reach_m = std::max({reach_m, std::abs(point.x()), std::abs(point.y())});
  }
  const double half_m = static_cast<double>(reach_m) + 0.5;
  matcher.set_target(stamped,
                     {.half_width_m = half_m, .half_height_m = half_m, .largest_shift_m = kReachM});
  const auto peaks = matcher.search(source_m, Pose2::identity(),
                                    {kReachM, kReachM, std::clamp(2.3 * turn_rad, 0.3, 1.6)});
  if (peaks.empty()) return std::nullopt;
  return PairPeak{refined(matcher, source_m, peaks.front().target_from_source),
                  peaks.front().score};
}

/// The scan behind sees what the one ahead sees, not the other way round: a scanner that moves
/// away from what it sees has most of the second scan in unseen space, and a corridor then matches
/// best where it did not move. The clearly better match of both is taken.
std::optional<MatchedPair> match(CorrelativeMatcher& matcher, const ScanPair& pair,
                                 const AssumedBeams& beams, const LogCorrection& correction) {
  constexpr double kClearlyBetter = 0.05;
  const Pose2 by_odometry = motion_by_odometry(pair, correction);
  if (!is_within_reach(by_odometry)) return std::nullopt;
  const double turn_rad = std::abs(by_odometry.heading_rad);
  const auto ahead = best_match(matcher, pair.first, pair.second, beams, correction, turn_rad);
  const auto behind = best_match(matcher, pair.second, pair.first, beams, correction, turn_rad);
  if (!ahead && !behind) return std::nullopt;
  const bool takes_behind = behind && (!ahead || behind->score > ahead->score + kClearlyBetter);
  return MatchedPair{
      .by_odometry = by_odometry,
      .by_scans = takes_behind ? inverse(behind->target_from_source) : ahead->target_from_source,
      .score = takes_behind ? behind->score : ahead->score,
      .first_scan = pair.first_scan,
      .second_scan = pair.second_scan};
}

}  // namespace

std::vector<MatchedPair> match_all(std::span<const ScanPair> pairs, const AssumedBeams& beams,
                                   const LogCorrection& correction) {
  CorrelativeMatcher matcher(
      {.resolution_m = 0.1, .smear_sigma_m = 0.1, .heading_step_rad = 0.01, .min_score = 0.45});
  std::vector<MatchedPair> matched;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    auto found = match(matcher, pairs[i], beams, correction);
    if (!found) continue;
    found->number = i;
    matched.push_back(*found);
  }
  return matched;
}

void take_odometry_anew(std::span<const ScanPair> pairs, const LogCorrection& correction,
                        std::vector<MatchedPair>& matched) {
  for (MatchedPair& pair : matched)
    pair.by_odometry = motion_by_odometry(pairs[pair.number], correction);
}

std::size_t pairs_within_reach(std::span<const ScanPair> pairs, const LogCorrection& correction) {
  return static_cast<std::size_t>(std::ranges::count_if(pairs, [&](const ScanPair& pair) {
    return is_within_reach(motion_by_odometry(pair, correction));
  }));
}

}  // namespace slammot::matching
