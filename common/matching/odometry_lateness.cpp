#include "common/matching/odometry_lateness.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

namespace slammot::matching {
namespace {

using geometry::Pose2;

constexpr double kFarthest_s = 1.0;
constexpr int kSteps = 50;  // in either direction
constexpr double kStep_s = kFarthest_s / kSteps;
constexpr double kLeast_s = 0.08;  // a smaller lateness is estimated during the drive
constexpr std::size_t kFewestCompared = 12;
constexpr double kTurnSigma_rad = 0.012;
constexpr double kTurnShare = 0.05;
constexpr double kStraight_rad = 0.05;
constexpr double kWaySigma_m = 0.05;
constexpr double kWayShare = 0.06;
constexpr double kMostSquaredError = 9.0;  // of one pair; limits the effect of wrong matches
constexpr double kLeastError = 0.2;
constexpr double kClearGain = 12.0;  // in mean squared errors: an F statistic of one parameter,
                                     // with a dozen candidate delays

std::optional<Pose2> pose_at(std::span<const TimedPose> odometry, double time_s) {
  const auto after = std::ranges::lower_bound(odometry, time_s, {}, &TimedPose::time_s);
  if (after == odometry.begin() || after == odometry.end()) return std::nullopt;
  const TimedPose& before = *(after - 1);
  const double span_s = after->time_s - before.time_s;
  return geometry::interpolate(before.pose, after->pose,
                               span_s > 0.0 ? (time_s - before.time_s) / span_s : 1.0);
}

/// A pair of scans, with the times of both.
struct TimedPair {
  ScanPairMotion motion;
  double first_s = 0.0;
  double second_s = 0.0;
};

std::optional<Pose2> motion_at(const TimedPair& pair, std::span<const TimedPose> odometry,
                               double delay_s) {
  return motion_between(odometry, pair.first_s + delay_s, pair.second_s + delay_s);
}

double squared_turn_error(const ScanPairMotion& pair, double turn_rad) {
  const double turn = geometry::wrap_angle(turn_rad - pair.turn_rad) /
                      (kTurnSigma_rad + kTurnShare * std::abs(pair.turn_rad));
  return turn * turn;
}

double squared_error(const ScanPairMotion& pair, const Pose2& by_odometry,
                     const MotionScale& scale) {
  const double turn = squared_turn_error(pair, scale.turn * by_odometry.heading_rad);
  const double way = (scale.way * by_odometry.translation_m().norm() - pair.way_m) /
                     (kWaySigma_m + kWayShare * pair.way_m);
  const bool is_straight = std::abs(pair.turn_rad) < kStraight_rad;  // otherwise the laser's way
                                                                     // differs from that of the
                                                                     // base
  return std::min(turn + (is_straight ? way * way : 0.0), kMostSquaredError);
}

/// A delay changes the ratio of turns by some percent. Wheels that turn too much or too little by
/// more than that would look like a delay. 0, as a ratio of no turns is, says nothing.
double turn_scale_beside_delays(double turn_scale) {
  constexpr double kByDelay = 0.1;
  return turn_scale > 0.0 && std::abs(turn_scale - 1.0) > kByDelay ? turn_scale : 1.0;
}

/// Pairs that odometry covers at every delay.
std::vector<TimedPair> covered(std::span<const ScanPairMotion> pairs,
                               std::span<const double> scan_times_s,
                               std::span<const TimedPose> odometry) {
  std::vector<TimedPair> some;
  for (const ScanPairMotion& motion : pairs) {
    if (motion.second_scan >= scan_times_s.size()) continue;
    const TimedPair pair{motion, scan_times_s[motion.first_scan], scan_times_s[motion.second_scan]};
    if (motion_at(pair, odometry, -kFarthest_s) && motion_at(pair, odometry, kFarthest_s))
      some.push_back(pair);
  }
  return some;
}

/// Whether odometry read so much later fits the turns better than a vehicle that never turns. Turns
/// that are noise do not, whenever they are read; but other noise is read at each delay, so that
/// one of them fits best by far.
bool tells_turns(const std::vector<TimedPair>& compared, std::span<const TimedPose> odometry,
                 double delay_s, double turn_scale) {
  double by_odometry = 0.0;
  double without = 0.0;
  for (const TimedPair& pair : compared) {
    const double turn_rad = turn_scale * motion_at(pair, odometry, delay_s)->heading_rad;
    by_odometry += std::min(squared_turn_error(pair.motion, turn_rad), kMostSquaredError);
    without += std::min(squared_turn_error(pair.motion, 0.0), kMostSquaredError);
  }
  return by_odometry < without;
}

}  // namespace

std::optional<Pose2> motion_between(std::span<const TimedPose> odometry, double first_s,
                                    double second_s) {
  const auto first = pose_at(odometry, first_s);
  const auto second = pose_at(odometry, second_s);
  if (!first || !second) return std::nullopt;
  return geometry::inverse(*first) * *second;
}

double odometry_lateness_s(std::span<const ScanPairMotion> pairs,
                           std::span<const double> scan_times_s,
                           std::span<const TimedPose> odometry, const MotionScale& measured) {
  const std::vector<TimedPair> compared = covered(pairs, scan_times_s, odometry);
  if (compared.size() < kFewestCompared || !(measured.way > 0.0)) return 0.0;
  const MotionScale scale{measured.way, turn_scale_beside_delays(measured.turn)};
  std::vector<double> errors;
  for (int step = -kSteps; step <= kSteps; ++step) {
    double sum = 0.0;
    for (const TimedPair& pair : compared)
      sum += squared_error(pair.motion, *motion_at(pair, odometry, step * kStep_s), scale);
    errors.push_back(sum);
  }
  const auto best = std::ranges::min_element(errors) - errors.begin();
  const auto at = [&](std::ptrdiff_t i) { return errors[static_cast<std::size_t>(i)]; };
  // a bad fit needs a larger improvement
  const double usual_error = std::max(at(best) / static_cast<double>(compared.size()), kLeastError);
  if (best == 0 || best == 2 * kSteps || at(kSteps) - at(best) < kClearGain * usual_error)
    return 0.0;
  const double bend = at(best - 1) - 2.0 * at(best) + at(best + 1);
  const double within =
      bend > 0.0 ? std::clamp(0.5 * (at(best - 1) - at(best + 1)) / bend, -0.5, 0.5) : 0.0;
  const double delay_s = (static_cast<double>(best - kSteps) + within) * kStep_s;
  const bool is_large = std::abs(delay_s) >= kLeast_s;
  return is_large && tells_turns(compared, odometry, delay_s, scale.turn) ? delay_s : 0.0;
}

}  // namespace slammot::matching
