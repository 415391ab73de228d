#include "common/matching/odometry_timing.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "common/matching/common_factor.hpp"
#include "common/matching/lateness_line.hpp"
#include "common/matching/pair_registration.hpp"

namespace slammot::matching {
namespace {

using geometry::Pose2;

constexpr std::size_t kFewestTimed = 12;
constexpr double kLeastTimingError = 0.2;
constexpr double kNearlyStraight_rad = 0.05;
constexpr double kTimingReach_s = 0.16;  // of the search around a rough delay
constexpr double kFactorSigma = 0.05;    // of the common factor of turns, and of ways

double middle_s(const MotionByScans& motion) { return 0.5 * (motion.first_s + motion.second_s); }

/// Delay of odometry that may grow with time.
struct Delay {
  double late_s = 0.0;  ///< At at_s.
  double at_s = 0.0;
  double drift = 0.0;

  double of_s(const MotionByScans& motion) const {
    return late_s + drift * (middle_s(motion) - at_s);
  }
};

std::optional<Pose2> motion_at(const MotionByScans& motion, std::span<const TimedPose> odometry,
                               double delay_s) {
  return motion_between(odometry, motion.first_s + delay_s, motion.second_s + delay_s);
}

Pose2 laser_in_base(const AssumedBeams& beams) {
  return {beams.laser_in_base_m.x(), beams.laser_in_base_m.y(), beams.laser_heading_rad};
}

/// A turn or a way of a motion by odometry.
using QuantityOf = std::function<double(const Pose2&)>;

double turn_of(const Pose2& motion) { return motion.heading_rad; }
double way_of(const Pose2& motion) { return motion.translation_m().norm(); }

/// Of the laser, for a motion of the base.
QuantityOf way_of_laser(const AssumedBeams& beams) {
  return [base_from_laser = laser_in_base(beams)](const Pose2& motion) {
    return way_of(geometry::inverse(base_from_laser) * motion * base_from_laser);
  };
}

/// Infinite where odometry does not cover all.
double error_at(const std::vector<MotionByScans>& motions, std::span<const TimedPose> odometry,
                const Delay& delay, const QuantityOf& quantity_of) {
  std::vector<TwiceMeasured> quantities;
  for (const MotionByScans& motion : motions) {
    const auto by_odometry = motion_at(motion, odometry, delay.of_s(motion));
    if (!by_odometry) return std::numeric_limits<double>::infinity();
    quantities.push_back({motion.by_scans, motion.sigma, quantity_of(*by_odometry)});
  }
  return error_with_best_factor(quantities, kFactorSigma);
}

/// With odometry read so much later.
double error_at(const MotionsByScans& motions, const LogToTime& log, const Delay& delay) {
  return error_at(motions.turns, log.odometry, delay, turn_of) +
         error_at(motions.ways, log.odometry, delay, way_of_laser(log.beams));
}

/// Of a change of the delay, by motion.
using ShareOf = std::function<double(const MotionByScans&)>;

double information_at(const std::vector<MotionByScans>& motions,
                      std::span<const TimedPose> odometry, const Delay& delay,
                      const ShareOf& share_of, const QuantityOf& quantity_of) {
  constexpr double kApart_s = 0.02;
  std::vector<DelayedQuantity> quantities;
  for (const MotionByScans& motion : motions) {
    const double delay_s = delay.of_s(motion);
    const auto before = motion_at(motion, odometry, delay_s - kApart_s);
    const auto after = motion_at(motion, odometry, delay_s + kApart_s);
    if (!before || !after) continue;
    quantities.push_back(
        {.by_odometry = 0.5 * (quantity_of(*after) + quantity_of(*before)),
         .change_per_s =
             share_of(motion) * (quantity_of(*after) - quantity_of(*before)) / (2.0 * kApart_s),
         .sigma = motion.sigma});
  }
  return information_about_delay(quantities, kFactorSigma);
}

/// About the delay [1/s^2].
double information_at(const MotionsByScans& motions, const LogToTime& log, const Delay& delay,
                      const ShareOf& share_of) {
  return information_at(motions.turns, log.odometry, delay, share_of, turn_of) +
         information_at(motions.ways, log.odometry, delay, share_of, way_of);
}

/// Those that odometry covers at each delay around the rough one.
MotionsByScans covered(MotionsByScans motions, const LogToTime& log, double reach_s) {
  const auto is_left_out = [&](const MotionByScans& motion) {
    return !motion_at(motion, log.odometry, log.around_s - reach_s) ||
           !motion_at(motion, log.odometry, log.around_s + reach_s);
  };
  std::erase_if(motions.turns, is_left_out);
  std::erase_if(motions.ways, is_left_out);
  return motions;
}

void add_known(const MotionByScans& times, const geometry::UncertainPose2& first_from_second,
               MotionsByScans& motions) {
  constexpr double kKnown_m = 0.05;  // one sigma
  constexpr double kKnown_rad = 0.01;
  constexpr double kLeastSigma_rad = 0.003;
  constexpr double kLeastSigma_m = 0.02;
  const auto& [motion, covariance] = first_from_second;
  if (covariance(2, 2) < kKnown_rad * kKnown_rad)
    motions.turns.push_back({times.first_s, times.second_s, motion.heading_rad,
                             std::hypot(kLeastSigma_rad, std::sqrt(covariance(2, 2)))});
  const double way_m = motion.translation_m().norm();
  if (way_m <= 0.0 || std::abs(motion.heading_rad) > kNearlyStraight_rad) return;
  const geometry::Vector2 along = motion.translation_m() / way_m;
  const double variance_m2 = along.dot(covariance.topLeftCorner<2, 2>() * along);
  if (variance_m2 <= kKnown_m * kKnown_m)
    motions.ways.push_back(
        {times.first_s, times.second_s, way_m, std::hypot(kLeastSigma_m, std::sqrt(variance_m2))});
}

}  // namespace

MotionsByScans motions_by_scans(const LogToTime& log) {
  constexpr double kSigma_m = 0.3;
  constexpr double kSigma_rad = 0.06;
  constexpr double kMatchedShare = 0.5;
  const Pose2 base_from_laser = laser_in_base(log.beams);
  PointToLineMatcher matcher;
  MotionsByScans motions;
  for (const ScanPair& pair : log.pairs) {
    if (pair.second_scan >= log.scan_times_s.size()) continue;
    const MotionByScans times{log.scan_times_s[pair.first_scan], log.scan_times_s[pair.second_scan],
                              0.0, 1.0};
    const auto motion = motion_at(times, log.odometry, log.around_s);
    if (!motion) continue;
    const geometry::UncertainPose2 prior{
        geometry::inverse(base_from_laser) * *motion * base_from_laser,
        Eigen::Vector3d(kSigma_m, kSigma_m, kSigma_rad).cwiseAbs2().asDiagonal()};
    const PointToLineResult found =
        register_pair(matcher, pair, log.beams, log.range_unit_m, prior);
    if (found.matched_share > kMatchedShare) add_known(times, found.map_from_base, motions);
  }
  return motions;
}

std::optional<OdometryTiming> odometry_timing(const MotionsByScans& motions, const LogToTime& log) {
  constexpr double kFineStep_s = 0.004;
  constexpr int kFineSteps = static_cast<int>(kTimingReach_s / kFineStep_s);
  constexpr int kBendSteps = 5;  // over which the curve of errors is taken for a parabola
  const MotionsByScans used = covered(motions, log, kTimingReach_s);
  if (used.count() < kFewestTimed) return std::nullopt;
  std::vector<double> errors;
  for (int step = -kFineSteps; step <= kFineSteps; ++step)
    errors.push_back(error_at(used, log, {log.around_s + step * kFineStep_s, 0.0, 0.0}));
  const auto best = static_cast<int>(std::ranges::min_element(errors) - errors.begin());
  if (best < kBendSteps || best + kBendSteps > 2 * kFineSteps) return std::nullopt;
  const auto at = [&](int i) { return errors[static_cast<std::size_t>(i)]; };
  const double bend =
      (at(best - kBendSteps) - 2.0 * at(best) + at(best + kBendSteps)) / (kBendSteps * kBendSteps);
  if (!(bend > 0.0)) return std::nullopt;
  const double usual_error =
      std::max(at(best) / static_cast<double>(used.count()), kLeastTimingError);
  const double slope = (at(best + kBendSteps) - at(best - kBendSteps)) / (2.0 * kBendSteps);
  const double late_s = log.around_s + (best - kFineSteps - slope / bend) * kFineStep_s;
  const double information =
      information_at(used, log, {late_s, 0.0, 0.0}, [](const MotionByScans&) { return 1.0; });
  if (!(information > 0.0)) return std::nullopt;
  return OdometryTiming{
      late_s, std::sqrt(std::max(usual_error, 1.0)) *
                  std::max(kFineStep_s * std::sqrt(2.0 / bend), 1.0 / std::sqrt(information))};
}

std::optional<OdometryDrift> odometry_drift(const MotionsByScans& motions, const LogToTime& log) {
  constexpr double kMostDrift = 2e-3;  // clocks of computers differ by far less
  constexpr double kMostChange_s = 0.6;
  constexpr double kLeastChange_s = 0.02;  // less is half of that at both ends: 0.1 m at 10 m/s
  constexpr double kSigmas = 5.0;
  if (log.scan_times_s.size() < 2) return std::nullopt;
  const double duration_s = log.scan_times_s.back() - log.scan_times_s.front();
  const double half_time_s = 0.5 * (log.scan_times_s.back() + log.scan_times_s.front());
  const double most_change_s = std::min(kMostChange_s, kMostDrift * duration_s);
  if (most_change_s < 2.0 * kLeastChange_s) return std::nullopt;
  const MotionsByScans used = covered(motions, log, kTimingReach_s + most_change_s);
  if (used.count() < kFewestTimed) return std::nullopt;
  const auto error_of = [&](double late_s, double change_s) {
    return error_at(used, log, {late_s, half_time_s, change_s / duration_s});
  };
  const auto line = best_lateness_line(error_of, log.around_s, most_change_s);
  if (!line) return std::nullopt;
  const double drift = line->change_s / duration_s;
  const double information = information_at(
      used, log, {line->late_s, half_time_s, drift},
      [&](const MotionByScans& motion) { return (middle_s(motion) - half_time_s) / duration_s; });
  if (!(information > 0.0)) return std::nullopt;
  const double unit = std::max(1.0, line->error / static_cast<double>(used.count()));
  const double sigma_s =
      std::sqrt(unit) * std::max(line->sigma_change_s, 1.0 / std::sqrt(information));
  const bool is_certain = std::abs(line->change_s) > std::max(kLeastChange_s, kSigmas * sigma_s) &&
                          line->error_without_change - line->error > kSigmas * kSigmas * unit;
  return is_certain ? std::optional(OdometryDrift{line->late_s, half_time_s, drift}) : std::nullopt;
}

}  // namespace slammot::matching
