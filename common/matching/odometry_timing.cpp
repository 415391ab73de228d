#include "common/matching/odometry_timing.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "common/matching/lateness_line.hpp"
#include "common/matching/pair_registration.hpp"

namespace slammot::matching {
namespace {

using geometry::Pose2;

constexpr std::size_t kFewestTimed = 12;
constexpr double kWorstSquaredError = 9.0;  // of one pair; limits the effect of wrong matches
constexpr double kLeastTimingError = 0.2;
constexpr double kNearlyStraight_rad = 0.05;
constexpr double kTimingReach_s = 0.16;  // of the search around a rough delay
constexpr double kFactorSigma = 0.05;    // of the common factor of turns, and of ways

/// Times of two scans.
struct ScanTimesOfPair {
  double first_s = 0.0;
  double second_s = 0.0;
};

/// Motion of the laser between them, by registration.
struct RegisteredPair {
  ScanTimesOfPair pair;
  geometry::UncertainPose2 first_from_second;
};

/// Delay of odometry that may grow with time.
struct Delay {
  double late_s = 0.0;  ///< At at_s.
  double at_s = 0.0;
  double drift = 0.0;

  double of_s(const ScanTimesOfPair& pair) const {
    return late_s + drift * (0.5 * (pair.first_s + pair.second_s) - at_s);
  }
};

std::optional<Pose2> motion_at(const ScanTimesOfPair& pair, std::span<const TimedPose> odometry,
                               double delay_s) {
  return motion_between(odometry, pair.first_s + delay_s, pair.second_s + delay_s);
}

/// What scans say of a quantity, and how sure they are.
struct Quantity {
  double by_scans = 0.0;
  double sigma = 1.0;
};

/// Squared error of quantities by odometry, up to a common factor, against those by scans: the
/// factor that fits best is near 1. Large errors of single pairs are limited.
double error_with_best_factor(const std::vector<double>& by_odometry,
                              const std::vector<Quantity>& by_scans) {
  constexpr int kReweighings = 3;
  double factor = 1.0;
  double error = 0.0;
  for (int round = 0; round < kReweighings; ++round) {
    double weighted = 1.0 / (kFactorSigma * kFactorSigma);
    double information = weighted;
    error = 0.0;
    for (std::size_t i = 0; i < by_odometry.size(); ++i) {
      const double difference =
          (by_scans[i].by_scans - factor * by_odometry[i]) / by_scans[i].sigma;
      const double squared = difference * difference;
      error += std::min(squared, kWorstSquaredError);
      if (squared > kWorstSquaredError) continue;
      const double weight = 1.0 / (by_scans[i].sigma * by_scans[i].sigma);
      weighted += weight * by_odometry[i] * by_scans[i].by_scans;
      information += weight * by_odometry[i] * by_odometry[i];
    }
    factor = weighted / information;
  }
  return error;
}

/// Turns and ways of pairs that registered well.
struct Measurements {
  std::vector<ScanTimesOfPair> turning;
  std::vector<Quantity> turns;
  std::vector<ScanTimesOfPair> driving;
  std::vector<Quantity> ways;

  std::size_t count() const { return turns.size() + ways.size(); }
};

Pose2 laser_in_base(const AssumedBeams& beams) {
  return {beams.laser_in_base_m.x(), beams.laser_in_base_m.y(), beams.laser_heading_rad};
}

Measurements measurements_of(const std::vector<RegisteredPair>& pairs) {
  constexpr double kKnown_m = 0.05;  // one sigma
  constexpr double kKnown_rad = 0.01;
  constexpr double kLeastSigma_rad = 0.003;
  constexpr double kLeastSigma_m = 0.02;
  Measurements all;
  for (const RegisteredPair& pair : pairs) {
    const ScanTimesOfPair& timed = pair.pair;
    const auto& [motion, covariance] = pair.first_from_second;
    if (covariance(2, 2) < kKnown_rad * kKnown_rad) {
      all.turning.push_back(timed);
      all.turns.push_back(
          {motion.heading_rad, std::hypot(kLeastSigma_rad, std::sqrt(covariance(2, 2)))});
    }
    const double way_m = motion.translation_m().norm();
    if (way_m <= 0.0 || std::abs(motion.heading_rad) > kNearlyStraight_rad) continue;
    const geometry::Vector2 along = motion.translation_m() / way_m;
    const double variance_m2 = along.dot(covariance.topLeftCorner<2, 2>() * along);
    if (variance_m2 > kKnown_m * kKnown_m) continue;
    all.driving.push_back(timed);
    all.ways.push_back({way_m, std::hypot(kLeastSigma_m, std::sqrt(variance_m2))});
  }
  return all;
}

/// With odometry read so much later; infinite where it does not cover all pairs.
double error_at(const Measurements& all, std::span<const TimedPose> odometry,
                const Pose2& base_from_laser, const Delay& delay) {
  std::vector<double> turns;
  std::vector<double> ways;
  for (const ScanTimesOfPair& pair : all.turning) {
    const auto motion = motion_at(pair, odometry, delay.of_s(pair));
    if (!motion) return std::numeric_limits<double>::infinity();
    turns.push_back(motion->heading_rad);
  }
  for (const ScanTimesOfPair& pair : all.driving) {
    const auto motion = motion_at(pair, odometry, delay.of_s(pair));
    if (!motion) return std::numeric_limits<double>::infinity();
    ways.push_back(
        (geometry::inverse(base_from_laser) * *motion * base_from_laser).translation_m().norm());
  }
  return error_with_best_factor(turns, all.turns) + error_with_best_factor(ways, all.ways);
}

/// Information about the delay [1/s^2] in quantities of one kind: how much they change with it by
/// odometry, beyond what a common factor explains. Of a vehicle that drives evenly there is none,
/// whatever the curve of errors looks like. share_of: of a change of the delay, by pair.
template <typename QuantityOf, typename ShareOf>
double information_at(const std::vector<ScanTimesOfPair>& pairs,
                      const std::vector<Quantity>& measured, std::span<const TimedPose> odometry,
                      const Delay& delay, ShareOf share_of, QuantityOf quantity_of) {
  constexpr double kApart_s = 0.02;
  double by_delay = 0.0;
  double by_both = 0.0;
  double by_factor = 1.0 / (kFactorSigma * kFactorSigma);
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const double delay_s = delay.of_s(pairs[i]);
    const auto before = motion_at(pairs[i], odometry, delay_s - kApart_s);
    const auto after = motion_at(pairs[i], odometry, delay_s + kApart_s);
    if (!before || !after) continue;
    const double change =
        share_of(pairs[i]) * (quantity_of(*after) - quantity_of(*before)) / (2.0 * kApart_s);
    const double quantity = 0.5 * (quantity_of(*after) + quantity_of(*before));
    const double weight = 1.0 / (measured[i].sigma * measured[i].sigma);
    by_delay += weight * change * change;
    by_both += weight * change * quantity;
    by_factor += weight * quantity * quantity;
  }
  return by_delay - by_both * by_both / by_factor;
}

template <typename ShareOf>
double information_at(const Measurements& all, std::span<const TimedPose> odometry,
                      const Delay& delay, ShareOf share_of) {
  const auto turn = [](const Pose2& motion) { return motion.heading_rad; };
  const auto way = [](const Pose2& motion) { return motion.translation_m().norm(); };
  return information_at(all.turning, all.turns, odometry, delay, share_of, turn) +
         information_at(all.driving, all.ways, odometry, delay, share_of, way);
}

void keep_covered(double least_s, double most_s, std::span<const TimedPose> odometry,
                  std::vector<ScanTimesOfPair>& pairs, std::vector<Quantity>& measured) {
  std::size_t kept = 0;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    if (!motion_at(pairs[i], odometry, least_s) || !motion_at(pairs[i], odometry, most_s)) continue;
    pairs[kept] = pairs[i];
    measured[kept++] = measured[i];
  }
  pairs.resize(kept);
  measured.resize(kept);
}

/// All pairs whose registration, from odometry's motion so much later, matches.
Measurements measured(std::span<const ScanPair> pairs, const AssumedBeams& beams,
                      double range_unit_m, std::span<const double> scan_times_s,
                      std::span<const TimedPose> odometry, double around_s) {
  constexpr double kSigma_m = 0.3;
  constexpr double kSigma_rad = 0.06;
  constexpr double kMatchedShare = 0.5;
  const Pose2 base_from_laser = laser_in_base(beams);
  PointToLineMatcher matcher;
  std::vector<RegisteredPair> registered;
  for (const ScanPair& pair : pairs) {
    if (pair.second_scan >= scan_times_s.size()) continue;
    const ScanTimesOfPair times{scan_times_s[pair.first_scan], scan_times_s[pair.second_scan]};
    const auto motion = motion_at(times, odometry, around_s);
    if (!motion) continue;
    const geometry::UncertainPose2 prior{
        geometry::inverse(base_from_laser) * *motion * base_from_laser,
        Eigen::Vector3d(kSigma_m, kSigma_m, kSigma_rad).cwiseAbs2().asDiagonal()};
    const PointToLineResult found = register_pair(matcher, pair, beams, range_unit_m, prior);
    if (found.matched_share > kMatchedShare) registered.push_back({times, found.map_from_base});
  }
  return measurements_of(registered);
}

void keep_covered(double around_s, double reach_s, std::span<const TimedPose> odometry,
                  Measurements& all) {
  keep_covered(around_s - reach_s, around_s + reach_s, odometry, all.turning, all.turns);
  keep_covered(around_s - reach_s, around_s + reach_s, odometry, all.driving, all.ways);
}

}  // namespace

std::optional<OdometryTiming> odometry_timing(std::span<const ScanPair> pairs,
                                              const AssumedBeams& beams, double range_unit_m,
                                              std::span<const double> scan_times_s,
                                              std::span<const TimedPose> odometry,
                                              double around_s) {
  constexpr double kFineStep_s = 0.004;
  constexpr int kFineSteps = static_cast<int>(kTimingReach_s / kFineStep_s);
  constexpr int kBendSteps = 5;  // over which the curve of errors is taken for a parabola
  Measurements all = measured(pairs, beams, range_unit_m, scan_times_s, odometry, around_s);
  keep_covered(around_s, kTimingReach_s, odometry, all);
  const std::size_t count = all.count();
  if (count < kFewestTimed) return std::nullopt;
  std::vector<double> errors;
  for (int step = -kFineSteps; step <= kFineSteps; ++step)
    errors.push_back(
        error_at(all, odometry, laser_in_base(beams), {around_s + step * kFineStep_s, 0.0, 0.0}));
  const auto best = static_cast<int>(std::ranges::min_element(errors) - errors.begin());
  if (best < kBendSteps || best + kBendSteps > 2 * kFineSteps) return std::nullopt;
  const auto at = [&](int i) { return errors[static_cast<std::size_t>(i)]; };
  const double bend =
      (at(best - kBendSteps) - 2.0 * at(best) + at(best + kBendSteps)) / (kBendSteps * kBendSteps);
  if (!(bend > 0.0)) return std::nullopt;
  const double usual_error = std::max(at(best) / static_cast<double>(count), kLeastTimingError);
  const double slope = (at(best + kBendSteps) - at(best - kBendSteps)) / (2.0 * kBendSteps);
  const double late_s = around_s + (best - kFineSteps - slope / bend) * kFineStep_s;
  const double information =
      information_at(all, odometry, {late_s, 0.0, 0.0}, [](const ScanTimesOfPair&) { return 1.0; });
  if (!(information > 0.0)) return std::nullopt;
  return OdometryTiming{
      late_s, std::sqrt(std::max(usual_error, 1.0)) *
                  std::max(kFineStep_s * std::sqrt(2.0 / bend), 1.0 / std::sqrt(information))};
}

std::optional<OdometryDrift> odometry_drift(std::span<const ScanPair> pairs,
                                            const AssumedBeams& beams, double range_unit_m,
                                            std::span<const double> scan_times_s,
                                            std::span<const TimedPose> odometry, double around_s) {
  constexpr double kMostDrift = 2e-3;  // clocks of computers differ by far less
  constexpr double kMostChange_s = 0.6;
  constexpr double kLeastChange_s = 0.02;  // less is half of that at both ends: 0.1 m at 10 m/s
  constexpr double kSigmas = 5.0;
  if (scan_times_s.size() < 2) return std::nullopt;
  const double duration_s = scan_times_s.back() - scan_times_s.front();
  const double middle_s = 0.5 * (scan_times_s.back() + scan_times_s.front());
  const double most_change_s = std::min(kMostChange_s, kMostDrift * duration_s);
  if (most_change_s < 2.0 * kLeastChange_s) return std::nullopt;
  Measurements all = measured(pairs, beams, range_unit_m, scan_times_s, odometry, around_s);
  keep_covered(around_s, kTimingReach_s + most_change_s, odometry, all);
  if (all.count() < kFewestTimed) return std::nullopt;
  const auto error_of = [&](double late_s, double change_s) {
    return error_at(all, odometry, laser_in_base(beams), {late_s, middle_s, change_s / duration_s});
  };
  const auto line = best_lateness_line(error_of, around_s, most_change_s);
  if (!line) return std::nullopt;
  const double drift = line->change_s / duration_s;
  const double information = information_at(
      all, odometry, {line->late_s, middle_s, drift}, [&](const ScanTimesOfPair& pair) {
        return (0.5 * (pair.first_s + pair.second_s) - middle_s) / duration_s;
      });
  if (!(information > 0.0)) return std::nullopt;
  const double unit = std::max(1.0, line->error / static_cast<double>(all.count()));
  const double sigma_s =
      std::sqrt(unit) * std::max(line->sigma_change_s, 1.0 / std::sqrt(information));
  const bool is_certain = std::abs(line->change_s) > std::max(kLeastChange_s, kSigmas * sigma_s) &&
                          line->error_without_change - line->error > kSigmas * kSigmas * unit;
  return is_certain ? std::optional(OdometryDrift{line->late_s, middle_s, drift}) : std::nullopt;
}

}  // namespace slammot::matching
